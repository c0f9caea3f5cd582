// The bridge to OpenHaptics, as a process, with a stand-in for libHD.so that has its own thread and makes
// trouble.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstdlib>

#include "common/device_messages/device_messages.h"
#include "tests/integration/bridge/bridge_host.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using test::RecordedCall;
using wire::DriveState;

constexpr double kTouchForce = 3.3;  // N

class TouchBridge : public test::BridgeTest {
  protected:
    std::vector<std::string> command(const std::string& words,
                                     const std::vector<std::string>& more = {}) const {
        return test::bridgeCommand("bonemill_bridge_touch", "libstand_in_hd.so", words, record_file_, more);
    }
    // The last force was zero, the scheduler stopped first, and the device last.
    void expectStopped() {
        const auto& all = record();
        EXPECT_EQ(test::lastOf(all, "force").forceNorm(), 0);
        EXPECT_EQ(test::countOf(all, "unloaded"), 0);
        EXPECT_EQ(test::countOf(all, "torque_written"), 0);
        const auto calls = test::without(all, "force");
        ASSERT_GE(calls.size(), 4u);
        const size_t n = calls.size();
        EXPECT_EQ(calls[n - 3].name, "stop");
        EXPECT_EQ(calls[n - 2].name, "unschedule");
        EXPECT_EQ(calls[n - 1].name, "close");
    }
};

TEST_F(TouchBridge, GivesTheCommandedForceInTheAxesOfTheLibraryAndStops) {
    test::Process bridge(command("jitter takes_over skewed only_named"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    host.runPeriods(100);
    EXPECT_EQ(test::countOf(record(), "enable"), 0);
    EXPECT_GT(test::countOf(record(), "force"), 0) << "zero flows from the beginning";
    ASSERT_TRUE(host.engage());
    EXPECT_STREQ(host.description().name, "Touch");
    EXPECT_EQ(host.description().serial, 815u);
    EXPECT_NEAR(host.description().max_force, kTouchForce, 1e-12);
    EXPECT_NEAR(host.description().workspace_radius, 0.035, 1e-12);
    EXPECT_EQ(host.description().abilities, kAbilityForce | kAbilityOrientation);
    // It says (10, 20, 25 to 35) mm with x right, y up, z to the user; the workspace's middle is (0, 20, 0).
    EXPECT_NEAR(host.state().p_DT[0], -0.010, 1e-9);
    EXPECT_NEAR(host.state().p_DT[1], 0.030, 0.0051);
    EXPECT_NEAR(host.state().p_DT[2], 0, 1e-9);
    EXPECT_NEAR(host.state().q_DT[0], 1, 1e-3);
    EXPECT_NEAR(host.state().load, 0.25, 1e-6);
    EXPECT_TRUE(host.state().inputs & (2u << wire::kFirstButtonInput));
    host.want(true, {1, 2, 0.5f, 0, 0, 1});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > std::sqrt(5.25) - 1e-6; }));
    const RecordedCall force = lastForce();
    EXPECT_NEAR(force.values[0], -1, 1e-5);
    EXPECT_NEAR(force.values[1], 0.5, 1e-5);
    EXPECT_NEAR(force.values[2], 2, 1e-5);
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kTouchForce);
}

TEST_F(TouchBridge, ScalesWhatIsTooLargeAndFadesWhenTheHostIsSilent) {
    test::Process bridge(command("heap stalls"));
    {
        BridgeHost host(bridge);
        host.want(true, {30, 40, 0, 0, 0, 0});
        ASSERT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > kTouchForce - 1e-6; }));
    }
    EXPECT_TRUE(test::waitFor([&] { return lastForce().forceNorm() == 0; }));
    const int so_far = test::countOf(record(), "force");
    EXPECT_TRUE(test::waitFor([&] { return test::countOf(record(), "force") > so_far + 50; }));
    bridge.signal(SIGINT);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kTouchForce);
}

TEST_F(TouchBridge, WaitsForCalibrationAndAsksForIt) {
    test::Process bridge(command("calibrates_at=500 no_limit"));
    BridgeHost host(bridge);
    host.want(true, {1, 0, 0, 0, 0, 0});
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    EXPECT_FALSE(host.state().inputs & wire::kInputHomed);
    EXPECT_NE(host.drive(), DriveState::kOperationEnabled);
    EXPECT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    EXPECT_GT(test::countOf(record(), "calibrate"), 0);
    EXPECT_TRUE(host.state().inputs & wire::kInputHomed);
    EXPECT_NEAR(host.description().max_force, 2, 1e-12) << "the library does not say what the arm can do";
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), 2);
}

TEST_F(TouchBridge, TellsOfWarmMotorsAndOfALostArm) {
    test::Process bridge(command("warm_at=600 loses_at=1200"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultOverTemperature; }));
    EXPECT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    EXPECT_TRUE(host.runUntil([&] { return host.state().fault_code == 0x0302; }))
        << "the error that came first";
    host.runUntil([&] { return !bridge.isRunning(); });
    EXPECT_EQ(bridge.wait().exit_code, 1);
    expectStopped();
    test::expectHarmless(record(), kTouchForce);
}

TEST_F(TouchBridge, NaNIsNoPose) {
    test::Process bridge(command("nan_at=400"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultSdk; }));
    EXPECT_TRUE(std::isfinite(host.state().p_DT[0]));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kTouchForce);
}

class HangingTouchBridge : public TouchBridge, public testing::WithParamInterface<const char*> {};

TEST_P(HangingTouchBridge, EndsInTime) {
    // On purpose the bridge ends without waiting for threads that hang.
    const char* const options = std::getenv("TSAN_OPTIONS");
    setenv("TSAN_OPTIONS", (std::string(options ? options : "") + " report_thread_leaks=0").c_str(), 1);
    test::Process bridge(command(GetParam()));
    {
        BridgeHost host(bridge);
        ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
        const bool hangs_while_it_runs = std::string(GetParam()) != "stop_hangs";
        ASSERT_TRUE(
            host.runUntil([&] { return !hangs_while_it_runs || test::countOf(record(), "hangs") > 0; }));
    }
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 3);
    EXPECT_GT(test::countOf(record(), "stop"), 0);
    test::expectHarmless(record(), kTouchForce);
}

INSTANTIATE_TEST_SUITE_P(Calls, HangingTouchBridge, testing::Values("hangs_at=300", "stop_hangs"));

TEST_F(TouchBridge, ProbesWithoutForceAndSaysWhatIsNotThere) {
    const test::Finished probe = test::run(command("", {"--probe"}));
    EXPECT_EQ(probe.exit_code, 0) << probe.err;
    EXPECT_NE(probe.out.find("Touch, serial 815"), std::string::npos) << probe.out;
    EXPECT_EQ(test::countOf(record(), "force"), 0);
    EXPECT_EQ(test::countOf(record(), "start"), 0);
    const test::Finished none = test::run(command("no_device"));
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_NE(none.err.find("device: "), std::string::npos) << none.err;
    EXPECT_NE(none.err.find("error 0x0300"), std::string::npos) << none.err;
    EXPECT_EQ(test::run(command("errors_never_end")).exit_code, 2);
}

TEST_F(TouchBridge, TestsItself) {
    const test::Finished finished = test::run(command("jitter", {"--self-test", "--seconds", "0.3"}));
    EXPECT_EQ(finished.exit_code, 0) << finished.err << finished.out;
    EXPECT_NE(finished.out.find("calibrated: yes"), std::string::npos) << finished.out;
    test::expectHarmless(record(), 0);
    expectStopped();
}

}  // namespace
}  // namespace bonemill
