// Guests of each role send damaged frames at any time, in bursts, in torn TLS records, with and without an
// end: the gateway closes them, goes on for everybody else, and comes to rest.
//   BONEMILL_MUTATED_FRAMES   so many frames for each role (default 1000)
//   BONEMILL_MUTATED_SEED     begins the random numbers (default 32)
#include <gtest/gtest.h>
#include <time.h>

#include <cstdlib>
#include <random>
#include <thread>

#include "tests/integration/gateway/gateway_guest.h"
#include "tests/integration/gateway/torn_line.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill::gateway {
namespace {

using std::chrono::milliseconds;

uint32_t wanted(const char* name, uint32_t otherwise) {
    const char* const text = std::getenv(name);
    return text ? uint32_t(std::strtoul(text, nullptr, 10)) : otherwise;
}

constexpr char kUpgradeRequest[] =
    "GET /session HTTP/1.1\r\nHost: there\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    "Sec-WebSocket-Protocol: bonemill.v1\r\n\r\n";

// A frame as RFC 6455, 5.2, has it, or not quite.
struct FrameShape {
    unsigned opcode = 2;
    bool is_last = true, is_masked = true;
    unsigned reserved = 0;     // three bits
    int length_bytes = -1;     // 0, 2 or 8; else as few as will do
    uint64_t claims_more = 0;  // than its payload has
};

std::string shaped(const std::string& payload, const FrameShape& shape, std::mt19937& random) {
    const uint64_t size = payload.size() + shape.claims_more;
    int length_bytes = shape.length_bytes;
    if (length_bytes < 0 || (length_bytes == 0 && size > 125))
        length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    std::string frame{char((shape.is_last ? 0x80 : 0) | shape.reserved << 4 | shape.opcode),
                      char((shape.is_masked ? 0x80 : 0) | (length_bytes == 0   ? int(size)
                                                           : length_bytes == 2 ? 126
                                                                               : 127))};
    for (int n = length_bytes; n-- > 0;) frame += char(size >> (8 * n));
    const uint32_t mask = shape.is_masked ? uint32_t(random()) : 0;
    if (shape.is_masked) frame.append(reinterpret_cast<const char*>(&mask), sizeof mask);
    for (size_t n = 0; n < payload.size(); ++n)
        frame += char(payload[n] ^ reinterpret_cast<const char*>(&mask)[n % 4]);
    return frame;
}

// What a guest may say, and more.
class Mutator {
  public:
    explicit Mutator(uint32_t seed) : random(seed) {
        FromGuest received, command, announce, hand, wish;
        received.mutable_received()->set_bytes(1);
        command.mutable_command()->set_sequence(1);
        command.mutable_command()->set_reset_volume(true);
        announce.mutable_announce()->set_frame_rate_hz(60);
        hand.mutable_hand()->set_is_holding(true);
        for (const double value : {0.1, 0.2, 0.3}) hand.mutable_hand()->add_p_wt_m(value);
        for (const double value : {1.0, 0.0, 0.0, 0.0}) hand.mutable_hand()->add_q_wt(value);
        wish.mutable_wish()->add_lacking(3);
        for (const FromGuest& message : {received, command, announce, hand, wish})
            messages_.push_back(message.SerializeAsString());
    }
    size_t below(size_t n) { return random() % n; }
    std::string message() { return messages_[below(messages_.size())]; }
    std::string noise(size_t most) {
        std::string bytes(below(most), '\0');
        for (char& c : bytes) c = char(random());
        return bytes;
    }
    std::string frame() {
        FrameShape shape;
        switch (below(14)) {
            case 0:
                return shaped(message(), {.opcode = 0, .is_last = below(2) == 0},
                              random);  // nothing to continue
            case 1:
                return shaped(message(), {.is_last = false}, random) + shaped(message(), {}, random);
            case 2:
                return shaped(noise(300), {.opcode = 1}, random);
            case 3:
                return shaped(message(), {.reserved = unsigned(1 + below(7))}, random);
            case 4:
                return shaped(message(), {.is_masked = false}, random);
            case 5:
                return shaped(noise(1000), {.opcode = unsigned(8 + below(3))},
                              random);  // too long for controls
            case 6:
                return shaped(noise(100), {.opcode = unsigned(8 + below(3)), .is_last = false}, random);
            case 7:
                return shaped(noise(50), {.opcode = unsigned(below(16))}, random);
            case 8:
                return shaped(message(), {.length_bytes = below(2) == 0 ? 2 : 8},
                              random);  // longer than need be
            case 9:
                return shaped(message(), {.claims_more = uint64_t(random()) << below(32)}, random);
            case 10:
                return shaped(std::string(17000 + below(30000), 'x'), {}, random);
            case 11:
                return test::mutated(shaped(message(), {}, random), random);
            case 12:
                return noise(64);
            default:
                return shaped(test::mutated(message(), random), {}, random);
        }
    }

    std::mt19937 random;

  private:
    std::vector<std::string> messages_;
};

class MutatedFrames : public testing::Test {
  protected:
    static constexpr uint32_t kNodes = 150, kTriangles = 300;
    static constexpr int kMostFramesOfBurst = 12;

    // The ticket that opens the seat of this invitation again and again.
    std::string ticketOf(const std::string& token) {
        TestGuest guest(gateway_, token, true);
        EXPECT_TRUE(guest.isWelcome());
        return guest.welcome ? guest.welcome->ticket() : "";
    }
    // One guest, from its connection to its end; returns how many frames it sent.
    int visit(Mutator& mutator, const std::string& ticket, uint32_t from) {
        TornLine line(gateway_.target().port, from);
        line.write(kUpgradeRequest);
        line.flush();
        std::string answer;
        for (int looks = 0; looks < 100 && !line.hasEnded() && answer.find("\r\n\r\n") == std::string::npos;
             ++looks)
            answer += line.read(50);
        if (mutator.below(8) != 0) line.write(hello(mutator, ticket));
        // Before the welcome, right after it, or while the bone comes.
        if (mutator.below(2) == 0) line.flush(), line.read(int(mutator.below(15)));
        int frames = 0;
        for (size_t bursts = 1 + mutator.below(3); bursts > 0 && !line.hasEnded(); --bursts) {
            std::string burst;
            for (size_t n = 1 + mutator.below(kMostFramesOfBurst); n > 0; --n, ++frames) {
                burst += mutator.frame();
                if (mutator.below(4) == 0) line.write(std::exchange(burst, ""));  // its own TLS record
            }
            line.write(burst);
            mutator.below(3) == 0 ? line.tear(mutator.random, mutator.below(4) != 0) : line.flush();
            if (mutator.below(8) == 0) line.writeRaw(mutator.noise(100));
            if (mutator.below(3) == 0) line.read(int(mutator.below(8)));
        }
        if (mutator.below(3) == 0) line.reset();
        return frames;
    }

    static std::string hello(Mutator& mutator, const std::string& ticket) {
        FromGuest message;
        message.mutable_hello()->set_token(ticket);
        message.mutable_hello()->set_version(kProtocolVersion);
        return shaped(message.SerializeAsString(), {}, mutator.random);
    }

    TestServer server_{kNodes, kTriangles};
    RunningGateway gateway_{
        invitationOf("Eva", "VIEWER", "observer") + invitationOf("Otto", "OPERATOR", "operator") +
        invitationOf("Ines", "INSTRUCTOR", "instructor") + invitationOf("Emil", "EXAMINER", "examiner") +
        invitationOf("Anna", "VIEWER", "anna", 0, 60)};
};

double processorSecondsOfThisProcess() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return double(used.tv_sec) + double(used.tv_nsec) * 1e-9;
}

TEST_F(MutatedFrames, OfEveryRoleHarmNobody) {
    const uint32_t frames = wanted("BONEMILL_MUTATED_FRAMES", 1000),
                   seed = wanted("BONEMILL_MUTATED_SEED", 32);
    TestGuest anna(gateway_, "anna", true);
    ASSERT_TRUE(anna.pollUntil([&] { return anna.isComplete() && anna.digest().count() == kNodes; }));
    uint32_t role_number = 0, revision = 1;
    for (const char* role : {"observer", "operator", "instructor", "examiner"}) {
        const std::string ticket = ticketOf(role);
        Mutator mutator(seed + role_number++);
        uint32_t sent = 0;
        for (uint32_t visits = 0; sent < frames; ++visits) {
            sent += uint32_t(visit(mutator, ticket, 1 + visits % 200));
            anna.poll(milliseconds(0));
            ASSERT_FALSE(anna.socket.hasEnded()) << role << ", seed " << seed << ", frame " << sent;
        }
        server_.show({syntheticNode(1, ++revision)});
        const NodeDigest digest = server_.publisher.digest();
        EXPECT_TRUE(anna.pollUntil([&] { return anna.digest() == digest; })) << role;
        TestGuest comes(gateway_, "anna", true);
        EXPECT_TRUE(comes.pollUntil([&] { return comes.isComplete() && comes.digest() == digest; }))
            << role << ": a new guest gets the whole bone";
    }
    std::this_thread::sleep_for(milliseconds(2500));  // the last ones are dropped by then
    const double before_s = processorSecondsOfThisProcess();
    std::this_thread::sleep_for(milliseconds(1000));
    EXPECT_LT(processorSecondsOfThisProcess() - before_s, 0.05) << "of a second: it has come to rest";
}

}  // namespace
}  // namespace bonemill::gateway
