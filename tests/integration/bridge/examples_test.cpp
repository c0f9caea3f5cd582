// The example bridges, which a laboratory starts from, speak to the host as the wire wants it.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "common/device_messages/device_messages.h"
#include "tests/integration/bridge/bridge_host.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using wire::DriveState;

// Python on a busy machine is no 5 ms device: a trip of its watchdog is reset, as a user would.
class ExampleBridge : public testing::TestWithParam<const char*> {
  protected:
    static std::vector<std::string> command() {
        const std::string examples = test::sourceDir() + "/device_daemon/bridges/examples/";
        if (GetParam() == std::string("python")) return {"/usr/bin/python3", examples + "spring_bridge.py"};
        return {test::helperDir() + "/spring_bridge"};
    }
};

TEST_P(ExampleBridge, MovesUnderTheCommandedForceAndLeavesInOrder) {
    test::Process bridge(command());
    BridgeHost host(bridge);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    EXPECT_EQ(std::string(host.description().name).substr(0, 6), "spring");
    EXPECT_EQ(host.description().max_force, 10);
    EXPECT_EQ(host.description().workspace_radius, 0.1);
    EXPECT_EQ(host.description().rate_hz, 1000u);
    EXPECT_EQ(host.description().abilities, kAbilityForce | kAbilitySimulated);
    EXPECT_EQ(host.state().q_DT[0], 1);
    host.want(true, {2, 0, -1, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    // A spring of 200 N/m gives way by 10 mm under 2 N.
    EXPECT_TRUE(host.runUntil([&] { return std::abs(host.state().p_DT[0] - 0.01) < 0.001; }));
    EXPECT_LT(host.state().p_DT[2], 0);
    host.want(false);
    EXPECT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kSwitchOnDisabled; }));
    bridge.signal(SIGTERM);
    EXPECT_TRUE(host.runUntil([&] { return host.state().inputs & wire::kInputLeaving; }));
    EXPECT_EQ(bridge.wait().exit_code, 0);
}

// 30 N would be 0.15 m; what it describes is 10 N. It swings before it rests.
TEST_P(ExampleBridge, GivesNoMoreThanItDescribes) {
    test::Process bridge(command());
    BridgeHost host(bridge);
    host.want(true, {0, 30, 0, 0, 0, 0});
    int resting = 0;
    EXPECT_TRUE(host.runUntil([&] {
        resting = std::abs(host.state().p_DT[1] - 0.05) < 0.002 ? resting + 1 : 0;
        return resting >= 100;
    }));
}

TEST_P(ExampleBridge, SaysWhichModeIsInForceAndHowOldTheCommandIs) {
    test::Process bridge(command());
    BridgeHost host(bridge);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    EXPECT_EQ(host.state().mode, wire::kModeNone);
    host.want(true);
    ASSERT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    EXPECT_EQ(host.state().mode, wire::kModeTorque);
    EXPECT_LT(host.state().command_age_10us, 65535);
}

TEST_P(ExampleBridge, GivesNoForceToASilentHostAndTakesAnother) {
    test::Process bridge(command());
    {
        BridgeHost host(bridge);
        host.want(true, {2, 0, 0, 0, 0, 0});
        ASSERT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    }
    usleep(100'000);  // many times the watchdog
    BridgeHost next(bridge);
    ASSERT_TRUE(next.runUntil([&] { return next.hasState(); }));
    EXPECT_TRUE(next.state().first_fault & wire::kFaultWatchdog);
    EXPECT_NE(next.drive(), DriveState::kOperationEnabled);
    next.want(true);
    EXPECT_TRUE(next.runUntil([&] { return next.drive() == DriveState::kOperationEnabled; }));
}

INSTANTIATE_TEST_SUITE_P(Languages, ExampleBridge, testing::Values("c", "python"));

}  // namespace
}  // namespace bonemill
