// A port survives its peers: those who send nonsense, half a message, do not read, or are too many.
#include "common/igtl_wire/igtl_port.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <map>

#include "common/igtl_wire/igtl_bytes.h"
#include "common/igtl_wire/igtl_messages.h"
#include "common/tcp/dial.h"

namespace bonemill::igtl {
namespace {

using namespace std::chrono_literals;

class PortTest : public testing::Test, protected LineSink {
  protected:
    void came(Line&) override { ++came_; }
    void heard(Line&, const Frame& frame) override { heard_.push_back(stringOf(frame.body).value_or("?")); }
    void gone(const Line&) override { ++gone_; }

    Descriptor dialled() {
        Dialled dialled = dial("127.0.0.1", port_.number(), 5s);
        EXPECT_EQ(dialled.problem, "");
        return std::move(dialled.socket);
    }
    static void put(const Descriptor& socket, const std::string& bytes) {
        EXPECT_EQ(send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
    }
    // The limit only ends a test that hangs.
    template <class Condition>
    bool stepUntil(const Condition& condition) {
        for (const auto end = Line::Clock::now() + 20s; Line::Clock::now() < end; port_.step(5ms))
            if (condition()) return true;
        return condition();
    }
    bool isWellServed() {
        heard_.clear();
        const Descriptor socket = dialled();
        put(socket, stringFrame("", 0, "well"));
        return stepUntil([&] { return heard_ == std::vector<std::string>{"well"}; });
    }

    int came_ = 0, gone_ = 0;
    std::vector<std::string> heard_;
    Port port_{
        "127.0.0.1", 0, {kWantedString}, {.most_lines = 8, .frame_time = 300ms, .read_time = 500ms}, *this};
};

TEST_F(PortTest, SendsAwayWhoeverSendsNonsense) {
    std::string huge;
    append(huge, uint16_t(1));
    huge += std::string("STRING\0\0\0\0\0\0", 12) + std::string(28, '\0');
    append(huge, uint64_t(4) << 30);
    append(huge, uint64_t(0));
    for (const std::string& bytes :
         {std::string("GET / HTTP/1.1\r\nHost: slicer\r\nAccept: */*\r\nConnection: close\r\n\r\n"),
          std::string(100, '\xff'), huge}) {
        const int before = gone_;
        const Descriptor socket = dialled();
        put(socket, bytes);
        EXPECT_TRUE(stepUntil([&] { return gone_ > before; }));
    }
    EXPECT_TRUE(heard_.empty());
    EXPECT_TRUE(isWellServed());
}

TEST_F(PortTest, HalfAMessageEndsInTimeAlsoWhenItDrips) {
    const std::string whole = stringFrame("", 0, "a long text, of which a byte comes now and then");
    const Descriptor half = dialled(), drip = dialled(), silent = dialled();
    put(half, whole.substr(0, 20));
    ASSERT_TRUE(stepUntil([&] { return came_ == 3; }));
    for (size_t n = 0; n < whole.size() && gone_ < 2; ++n) {
        put(drip, whole.substr(n, 1));
        const auto next = Line::Clock::now() + 20ms;
        stepUntil([&] { return Line::Clock::now() > next; });
    }
    EXPECT_TRUE(stepUntil([&] { return gone_ == 2; }));
    EXPECT_EQ(port_.lines().size(), 1u) << "who says nothing may listen";
    EXPECT_TRUE(heard_.empty());
}

// Each piece ends within a message, as those of a peer may that sends images without a pause.
TEST_F(PortTest, MessagesOfAnotherTypeEndOneAfterTheOther) {
    const Descriptor socket = dialled();
    const std::string other = frameOf("IMAGE", "", 0, std::string(100, 'x'));
    const std::string piece = other.substr(30) + other.substr(0, 30);
    put(socket, other.substr(0, 30));
    ASSERT_TRUE(stepUntil([&] { return came_ == 1; }));
    for (const auto end = Line::Clock::now() + 900ms; Line::Clock::now() < end && gone_ == 0;) {
        put(socket, piece);
        port_.step(20ms);
    }
    EXPECT_EQ(gone_, 0) << "three times as long as a message may take";
}

TEST_F(PortTest, WhoDoesNotReadCostsABoundAndNobodyElseWaits) {
    const Descriptor deaf = dialled(), reader = dialled();
    ASSERT_TRUE(stepUntil([&] { return came_ == 2; }));
    Line& deaf_line = *port_.lines()[0];
    const auto frame = std::make_shared<const std::string>(stringFrame("", 0, std::string(2000, 'x')));
    constexpr size_t kMost = 64 << 10;
    size_t most = 0, received = 0;
    uint64_t dropped = 0;
    const bool has_ended = stepUntil([&] {
        if (gone_ > 0) return true;
        for (const auto& line : port_.lines())
            for (int n = 0; n < 100; ++n) line->say(frame, kMost);
        most = std::max(most, deaf_line.waitingBytes());
        dropped = deaf_line.droppedFrames();
        char piece[1 << 16];
        while (recv(reader.get(), piece, sizeof piece, MSG_DONTWAIT) > 0) received += sizeof piece;
        return false;
    });
    EXPECT_TRUE(has_ended);
    EXPECT_LE(most, kMost + frame->size());
    EXPECT_GT(dropped, 100u);
    EXPECT_GT(received, 5'000'000u);
    ASSERT_EQ(port_.lines().size(), 1u);
    EXPECT_TRUE(isWellServed());
}

TEST_F(PortTest, AHundredPeersAreNoMoreThanItsLines) {
    std::vector<Descriptor> crowd;
    for (int n = 0; n < 100; ++n) crowd.push_back(dialled());
    EXPECT_TRUE(stepUntil([&] { return port_.refusedLines() == 92; }));
    EXPECT_EQ(port_.lines().size(), 8u);
    crowd.clear();
    EXPECT_TRUE(stepUntil([&] { return port_.lines().empty(); }));
    EXPECT_TRUE(isWellServed());
}

}  // namespace
}  // namespace bonemill::igtl
