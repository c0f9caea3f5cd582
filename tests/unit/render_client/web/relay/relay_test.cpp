#include "render_client/web/relay/relay.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>

#include "common/base/user_error.h"
#include "common/secrets/secrets.h"
#include "common/tcp/dial.h"
#include "common/tcp/listen.h"
#include "render_client/web/relay/relay_dialer.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

const std::string kSecret = "0123456789abcdef0123456789abcdef";
const std::string kTls = "\x16";

bool isReady(int socket, short what, std::chrono::milliseconds time = 5000ms) {
    pollfd wait{socket, what, 0};
    return poll(&wait, 1, int(time.count())) == 1 && (wait.revents & (what | POLLHUP | POLLERR)) != 0;
}

// Returns what comes until so many bytes are there, the line ends, or nothing more comes.
std::string hear(const Descriptor& line, size_t bytes, std::chrono::milliseconds patience = 5000ms) {
    std::string heard;
    char buffer[4096];
    while (heard.size() < bytes && isReady(line.get(), POLLIN, patience)) {
        const ssize_t count = recv(line.get(), buffer, std::min(sizeof buffer, bytes - heard.size()), 0);
        if (count <= 0) break;
        heard.append(buffer, size_t(count));
    }
    return heard;
}

bool hasEnded(const Descriptor& line, std::chrono::milliseconds patience = 5000ms) {
    char byte = 0;
    return isReady(line.get(), POLLIN, patience) && recv(line.get(), &byte, 1, 0) <= 0;
}

void tell(const Descriptor& line, std::string_view bytes) {
    while (!bytes.empty()) {
        ASSERT_TRUE(isReady(line.get(), POLLOUT));
        const ssize_t count = send(line.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        ASSERT_GT(count, 0);
        bytes.remove_prefix(size_t(count));
    }
}

// The log is made before threads ask for it: ThreadSanitizer does not see into its library.
const auto kLog = spdlog::default_logger();

// It runs on a thread of its own.
class RunningRelay {
  public:
    explicit RunningRelay(const RelayBounds& bounds = {}, uint16_t port = 0)
        : relay_({"127.0.0.1", port, kSecret}, bounds),
          thread_([this] { relay_.run([this] { return stop_.load(); }); }) {}
    ~RunningRelay() { stop(); }

    uint16_t port() const { return relay_.port(); }
    Descriptor dial() const {
        Dialled dialled = bonemill::dial("127.0.0.1", port(), 5000ms);
        EXPECT_TRUE(dialled.socket) << dialled.problem;
        return std::move(dialled.socket);
    }
    Descriptor guest(const std::string& first = kTls) const {
        Descriptor line = dial();
        tell(line, first);
        return line;
    }
    Relay::Counts stop() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        return relay_.counts();
    }

  private:
    std::atomic<bool> stop_ = false;
    Relay relay_;
    std::thread thread_;
};

// A gateway that says everything back.
class Echo {
  public:
    explicit Echo(uint16_t port, const std::string& secret = kSecret) {
        dialer_.emplace(RelayPlace{"127.0.0.1", port, secret},
                        [this](Descriptor line, const PeerAddress& guest) {
                            const std::lock_guard lock(mutex_);
                            guest_ = textOf(guest);
                            fresh_.push_back(std::move(line));
                        });
        thread_ = std::thread([this] { run(); });
    }
    ~Echo() {
        dialer_.reset();
        stop_ = true;
        thread_.join();
    }
    bool waitUntilConnected(std::chrono::milliseconds patience = 5000ms) const {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!dialer_->isConnected() && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(2ms);
        return dialer_->isConnected();
    }

    // Whom the relay named last.
    std::string lastGuest() {
        const std::lock_guard lock(mutex_);
        return guest_;
    }

  private:
    void run() {
        while (!stop_) {
            {
                const std::lock_guard lock(mutex_);
                for (Descriptor& line : fresh_) lines_.push_back(std::move(line));
                fresh_.clear();
            }
            std::vector<pollfd> waits;
            for (const Descriptor& line : lines_) waits.push_back({line.get(), POLLIN, 0});
            poll(waits.data(), waits.size(), 5);
            for (size_t i = 0; i < waits.size(); ++i)
                if (waits[i].revents != 0) answer(lines_[i]);
            std::erase_if(lines_, [](const Descriptor& line) { return !line; });
        }
    }
    // It takes no more than the guest takes back, and waits for nobody.
    void answer(Descriptor& line) {
        char buffer[16384];
        const ssize_t count = recv(line.get(), buffer, sizeof buffer, MSG_PEEK);
        if (count < 0 && errno == EAGAIN) return;
        const ssize_t said = count > 0 ? send(line.get(), buffer, size_t(count), MSG_NOSIGNAL) : -1;
        if (said > 0) recv(line.get(), buffer, size_t(said), 0);
        if (count <= 0 || (said <= 0 && errno != EAGAIN)) line = {};
    }

    std::mutex mutex_;
    std::string guest_;
    std::vector<Descriptor> fresh_, lines_;
    std::optional<RelayDialer> dialer_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

TEST(Relay, PassesOnWhatGuestAndGatewaySay) {
    const RunningRelay relay;
    Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    const Descriptor guest = relay.guest();
    tell(guest, "hello");
    EXPECT_EQ(hear(guest, 6), kTls + "hello");
    EXPECT_EQ(gateway.lastGuest(), "127.0.0.1");
}

TEST(Relay, TwoHundredGuestsAtOnceGetTheirOwnBytes) {
    constexpr int kGuests = 200;
    RunningRelay relay({.new_of_address = 400, .waiting_guests = 400});
    const Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    std::vector<Descriptor> guests;
    for (int i = 0; i < kGuests; ++i) guests.push_back(relay.guest());
    for (int i = 0; i < kGuests; ++i) tell(guests[size_t(i)], std::string(2000, char('a' + i % 26)));
    for (int i = 0; i < kGuests; ++i)
        ASSERT_EQ(hear(guests[size_t(i)], 2001), kTls + std::string(2000, char('a' + i % 26))) << i;
    EXPECT_EQ(relay.stop().guests, size_t(kGuests));
}

TEST(Relay, AGuestWithoutAGatewayIsTurnedAway) {
    const RunningRelay relay;
    EXPECT_TRUE(hasEnded(relay.guest()));
}

TEST(Relay, AGatewayWithAnotherSecretIsRefused) {
    RunningRelay relay;
    const Echo stranger(relay.port(), "another secret of thirty-two letters");
    EXPECT_FALSE(stranger.waitUntilConnected(300ms));
    const Relay::Counts counts = relay.stop();
    EXPECT_FALSE(counts.has_gateway);
    EXPECT_GE(counts.refused, 1u);
}

TEST(Relay, AProofSaidAgainIsWorthNothing) {
    const RunningRelay relay;
    const std::string greeting = greetingOf(RelayAsk::kControl, {});
    std::string first_proof;
    for (const bool is_again : {false, true}) {
        const Descriptor line = relay.dial();
        tell(line, greeting);
        const std::string heard = hear(line, std::tuple_size_v<RelayNonce>);
        ASSERT_EQ(heard.size(), std::tuple_size_v<RelayNonce>);
        RelayNonce nonce;
        std::copy(heard.begin(), heard.end(), nonce.begin());
        const RelayProof proof = proofOf(kSecret, greeting, nonce);
        if (!is_again) first_proof.assign(proof.begin(), proof.end());
        tell(line, first_proof);
        EXPECT_EQ(hear(line, 1), is_again ? "" : std::string(1, kRelayAccepted));
    }
}

TEST(Relay, NobodyTakesAGuestThatIsNotThere) {
    const RunningRelay relay;
    const Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    const Descriptor line = relay.dial();
    const std::string greeting = greetingOf(RelayAsk::kGuest, GuestId{'x'});
    tell(line, greeting);
    RelayNonce nonce;
    const std::string heard = hear(line, nonce.size());
    ASSERT_EQ(heard.size(), nonce.size());
    std::copy(heard.begin(), heard.end(), nonce.begin());
    const RelayProof proof = proofOf(kSecret, greeting, nonce);
    tell(line, {proof.data(), proof.size()});
    EXPECT_TRUE(hasEnded(line));
}

TEST(Relay, PlainTextAndSilenceAreTurnedAway) {
    const RunningRelay relay({.to_greet = 200ms});
    const Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    EXPECT_TRUE(hasEnded(relay.guest("GET / HTTP/1.1\r\n\r\n")));
    EXPECT_TRUE(hasEnded(relay.dial()));
    EXPECT_TRUE(hasEnded(relay.guest("BMREL")));
    EXPECT_TRUE(hasEnded(relay.guest("BMRELAX1" + std::string(17, 'D'))));
}

TEST(Relay, AThousandSilentLinesKeepNobodyOut) {
    const RunningRelay relay({.new_of_address = 8});
    const Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    allowDescriptors(4096);
    std::vector<Descriptor> silent;
    for (int i = 0; i < 1000; ++i) silent.push_back(relay.dial());
    size_t refused = 0;
    for (const Descriptor& line : silent) refused += hasEnded(line, 1ms);
    EXPECT_GE(refused, 900u);
    silent.clear();
    const Descriptor guest = relay.guest();
    EXPECT_EQ(hear(guest, 1), kTls);
}

TEST(Relay, AStalledGuestHoldsUpNobodyAndTakesABoundedMemory) {
    RunningRelay relay;
    const Echo gateway(relay.port());
    ASSERT_TRUE(gateway.waitUntilConnected());
    const Descriptor guest = relay.guest();
    // A dialled line of the gateway that floods its guest, who does not read.
    const Descriptor stalled = relay.guest();
    // The kernel's buffers of four connections hold up to 10 MB each before the first of them is full.
    constexpr size_t kMore = size_t(128) << 20;
    std::string flood(size_t(1) << 16, 'x');
    size_t said = 0;
    while (said < kMore && isReady(stalled.get(), POLLOUT, 200ms)) {
        const ssize_t count = send(stalled.get(), flood.data(), flood.size(), MSG_NOSIGNAL);
        if (count <= 0) break;
        said += size_t(count);
    }
    EXPECT_LT(said, kMore) << "nothing held the flood up";
    tell(guest, "still here");
    EXPECT_EQ(hear(guest, 11), kTls + "still here");
}

TEST(Relay, TheGatewayComesBackAfterTheRelayWasRestarted) {
    std::optional<RunningRelay> relay(std::in_place);
    const uint16_t port = relay->port();
    const Echo gateway(port);
    ASSERT_TRUE(gateway.waitUntilConnected());
    relay.reset();
    const auto end = std::chrono::steady_clock::now() + 5s;
    relay.emplace(RelayBounds{}, port);
    std::string heard;
    while (heard.empty() && std::chrono::steady_clock::now() < end) {
        heard = hear(relay->guest(), 1, 300ms);
        std::this_thread::sleep_for(20ms);
    }
    EXPECT_EQ(heard, kTls);
}

TEST(RelaySecret, MustBePrivateAndLong) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "secret";
    std::ofstream(path) << kSecret << "\n";
    chmod(path.c_str(), 0644);
    EXPECT_THROW(readSecret(path, "a relay"), UserError);
    chmod(path.c_str(), 0600);
    EXPECT_EQ(readSecret(path, "a relay"), kSecret);
    std::ofstream(path) << "short";
    EXPECT_THROW(readSecret(path, "a relay"), UserError);
    EXPECT_THROW(readSecret(path + "_not_there", "a relay"), UserError);
}

}  // namespace
}  // namespace bonemill
