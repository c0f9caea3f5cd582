// The virtual network does what the tests on it take for granted.
#include "tests/support/virtual_network.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>

namespace bonemill::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPort = 4000;

class Lines : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string missing = VirtualNetwork::enter(); !missing.empty()) GTEST_SKIP() << missing;
        if (const std::string missing = VirtualNetwork::missingForLines(); !missing.empty())
            GTEST_SKIP() << missing;
        network_ = std::make_unique<VirtualNetwork>();
    }
    static void send(const Descriptor& from, const Host& to, size_t bytes) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(kPort);
        inet_pton(AF_INET, to.address().c_str(), &address.sin_addr);
        const std::string datagram(bytes, 'x');
        sendto(from.number(), datagram.data(), bytes, 0, reinterpret_cast<const sockaddr*>(&address),
               sizeof address);
    }
    static bool receive(const Descriptor& at, int flags = 0) {
        char buffer[2000];
        return recv(at.number(), buffer, sizeof buffer, flags) > 0;
    }
    // Both ends know each other's hardware address afterwards.
    static void greet(const Descriptor& from, const Host& to, const Descriptor& at) {
        send(from, to, 1);
        ASSERT_TRUE(receive(at));
    }
    std::unique_ptr<VirtualNetwork> network_;
};

TEST_F(Lines, ACableCarriesUntilItIsUnplugged) {
    const Host a = network_->addHost(), b = network_->addHost();
    const Descriptor from = a.udpSocket(kPort), at = b.udpSocket(kPort);
    greet(from, b, at);
    b.unplug();
    send(from, b, 1);
    b.plugIn();
    EXPECT_FALSE(receive(at, MSG_DONTWAIT));
    greet(from, b, at);
}

TEST_F(Lines, ASlowLineTakesItsTime) {
    const Host a = network_->addHost(), b = network_->addHost({.rate_kbit_per_s = 1000, .delay_ms = 100});
    const Descriptor from = a.udpSocket(kPort), at = b.udpSocket(kPort);
    greet(from, b, at);
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < 50; ++i) send(from, b, 1000);  // 50 KB at 125 KB/s
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(receive(at)) << i;
    EXPECT_GT(Clock::now() - start, std::chrono::milliseconds(500));
}

TEST_F(Lines, ALossyLineLosesItsShare) {
    const Host a = network_->addHost(), b = network_->addHost({.loss_per_mille = 200});
    const Descriptor from = a.udpSocket(kPort), at = b.udpSocket(kPort);
    greet(from, b, at);
    int arrived = 0;
    for (int i = 0; i < 500; ++i) send(from, b, 10);
    while (receive(at, arrived < 300 ? 0 : MSG_DONTWAIT)) ++arrived;
    EXPECT_GE(arrived, 300);
    EXPECT_LE(arrived, 450);
}

TEST_F(Lines, AFullQueueLosesTheRest) {
    const Host a = network_->addHost(), b = network_->addHost({.rate_kbit_per_s = 8000, .queue_kib = 20});
    const Descriptor from = a.udpSocket(kPort), at = b.udpSocket(kPort);
    greet(from, b, at);
    for (int i = 0; i < 100; ++i) send(from, b, 1000);
    int arrived = 0;
    while (arrived < 100 && receive(at, arrived < 15 ? 0 : MSG_DONTWAIT)) ++arrived;
    EXPECT_GE(arrived, 15);
    EXPECT_LT(arrived, 100);
}

}  // namespace
}  // namespace bonemill::test
