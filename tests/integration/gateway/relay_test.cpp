// Guests who come through a relay find the gateway as those do who come directly; the relay learns nothing.
#include <fstream>

#include "common/base/user_error.h"
#include "tests/integration/gateway/gateway_guest.h"
#include "tests/integration/gateway/relayed_gateway.h"
#include "tests/integration/gateway/remote_viewer.h"
#include "tests/integration/gateway/wire_tap.h"

namespace bonemill::gateway {
namespace {

const std::string kRelayedToken = "a token that nobody on the way may read";

// Resident memory at its highest, MiB.
double peakMemoryOf(int pid) {
    std::ifstream status("/proc/" + std::to_string(pid) + "/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            double kib = 0;
            status >> kib;
            return kib / 1024;
        }
    return 0;
}

TEST(RelayedGateway, AGuestGetsTheWholeModelAndTheRelaySeesNothingOfIt) {
    TestServer server(60);
    RelayedGateway gateway(invitationOf("Anna the instructor", "INSTRUCTOR", kRelayedToken));
    gateway.startGateway();
    ASSERT_TRUE(gateway.waitUntilReached());
    const test::WireTap tap(gateway.relayPort());
    TestGuest anna(gateway.at(tap.port()), kRelayedToken, true);
    ASSERT_TRUE(anna.isWelcome());
    EXPECT_EQ(anna.welcome->name(), "Anna the instructor");
    ASSERT_TRUE(anna.pollUntil([&] { return anna.isComplete() && anna.digest().count() == 60; }));
    EXPECT_EQ(anna.digest(), server.publisher.digest());
    server.show({syntheticNode(3, 2), emptyNode(5, 2)});
    const NodeDigest digest = server.publisher.digest();
    ASSERT_TRUE(anna.pollUntil([&] { return anna.digest() == digest; }));

    const std::string heard = tap.heard();
    EXPECT_GT(heard.size(), anna.received) << "all of it went through there";
    ASSERT_GE(anna.a_node.size(), 64u);
    for (const std::string& plain :
         {std::string("Anna the instructor"), kRelayedToken, anna.welcome->ticket(), std::string("synthetic"),
          anna.a_node.substr(anna.a_node.size() / 2, 16)}) {
        EXPECT_EQ(heard.find(plain), std::string::npos) << plain;
        EXPECT_FALSE(RelayedGateway::hasSaid(gateway.relay(), plain)) << plain;
    }
    for (const std::string& secret : {kRelayedToken, anna.welcome->ticket()})
        EXPECT_FALSE(RelayedGateway::hasSaid(gateway.gatewayProgram(), secret)) << secret;
    EXPECT_TRUE(RelayedGateway::hasSaid(gateway.relay(), "a guest from 127.0.0.1"));
    EXPECT_TRUE(
        RelayedGateway::hasSaid(gateway.gatewayProgram(), "has come from 127.0.0.1 through the relay"));
    gateway.relay().signal(SIGTERM);
    EXPECT_EQ(gateway.relay().wait().exit_code, 0);
}

TEST(RelayedGateway, ARelayThatWasKilledIsFoundAgainAndGuestsComeBack) {
    TestServer server(20);
    RelayedGateway gateway(invitationOf("Anna", "VIEWER", kRelayedToken));
    gateway.startGateway();
    ASSERT_TRUE(gateway.waitUntilReached());
    RemoteViewer anna(gateway.throughRelay(), kRelayedToken);
    ASSERT_TRUE(anna.pollUntilComplete(server.publisher.digest()));
    gateway.relay().signal(SIGKILL);
    ASSERT_TRUE(anna.pollUntil([&] { return !anna.subscriber.hasServer(); }));
    server.show({syntheticNode(3, 2), emptyNode(5, 2)});
    gateway.startRelay();
    ASSERT_TRUE(anna.pollUntil([&] {
        server.tellStatus();
        return anna.subscriber.isComplete() && anna.subscriber.digest() == server.publisher.digest();
    }));
    EXPECT_TRUE(RelayedGateway::hasSaid(gateway.gatewayProgram(), "is lost"));
}

TEST(RelayedGateway, WithAnotherSecretItIsRefusedAndBothSaySo) {
    RelayedGateway gateway(invitationOf("Anna", "VIEWER", kRelayedToken));
    gateway.startGateway("another");
    EXPECT_TRUE(test::waitFor(
        [&] { return RelayedGateway::hasSaid(gateway.gatewayProgram(), "both must have the same secret"); }));
    EXPECT_TRUE(test::waitFor([&] {
        return RelayedGateway::hasSaid(gateway.relay(), "127.0.0.1 does not know the relay's secret");
    }));
    EXPECT_THROW(TestGuest(gateway.throughRelay(), kRelayedToken, true), UserError);
    EXPECT_TRUE(gateway.gatewayProgram().isRunning()) << "those in its own network still come";
}

// One silent address has its share, as without a relay, and takes nobody's place who comes from elsewhere.
TEST(RelayedGateway, SilentGuestsOfOneAddressKeepNobodyElseOut) {
    TestServer server(3);
    RelayedGateway gateway(invitationOf("Class", "VIEWER", kRelayedToken, 0, 3));
    gateway.startGateway();
    ASSERT_TRUE(gateway.waitUntilReached());
    std::vector<std::unique_ptr<TestGuest>> silent;
    for (size_t n = 0; n < Gateway::kMaxUnknown.of_address + 4; ++n)
        silent.push_back(std::make_unique<TestGuest>(gateway.throughRelay()));
    const test::WireTap elsewhere(gateway.relayPort(), "127.0.0.2");
    TestGuest anna(gateway.at(elsewhere.port()), kRelayedToken, true),
        otto(gateway.direct(), kRelayedToken, true);
    EXPECT_TRUE(anna.isWelcome());
    EXPECT_TRUE(otto.isWelcome()) << "the same address, but not the relay's";
    size_t open = 0;
    for (const auto& guest : silent) {
        guest->poll(std::chrono::milliseconds(0));
        open += !guest->socket.hasEnded();
    }
    EXPECT_LE(open, Gateway::kMaxUnknown.of_address);
}

TEST(RelayedGateway, AClassOfThirtyGetsTheWholeModel) {
    constexpr uint32_t kClass = 30;
    TestServer server(60);
    RelayedGateway gateway(invitationOf("Class", "VIEWER", kRelayedToken, 0, kClass), kClass);
    gateway.startGateway();
    ASSERT_TRUE(gateway.waitUntilReached());
    const double before = peakMemoryOf(test::workOf(gateway.relay()));
    std::vector<std::unique_ptr<TestGuest>> guests;
    for (uint32_t n = 0; n < kClass; ++n) {
        guests.push_back(std::make_unique<TestGuest>(gateway.throughRelay(), kRelayedToken, true));
        ASSERT_TRUE(guests.back()->isWelcome()) << n;
    }
    for (const auto& guest : guests)
        ASSERT_TRUE(guest->pollUntil([&] { return guest->isComplete() && guest->digest().count() == 60; }));
    server.show({syntheticNode(3, 2), emptyNode(5, 2)});
    const NodeDigest digest = server.publisher.digest();
    for (const auto& guest : guests) EXPECT_TRUE(guest->pollUntil([&] { return guest->digest() == digest; }));
    EXPECT_LT(peakMemoryOf(test::workOf(gateway.relay())) - before, 8)
        << "MiB; 64 KiB wait for each end at most";
}

}  // namespace
}  // namespace bonemill::gateway
