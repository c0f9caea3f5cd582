// The bridge to Force Dimension's SDK, as a process, with a stand-in for libdrd.so.3 that makes trouble.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>

#include "common/device_messages/device_messages.h"
#include "tests/integration/bridge/bridge_host.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using test::RecordedCall;
using wire::DriveState;

constexpr double kOmegaForce = 12;  // N

class ForceDimensionBridge : public test::BridgeTest {
  protected:
    std::vector<std::string> command(const std::string& words, const std::vector<std::string>& more = {},
                                     const std::string& library = "libstand_in_drd.so") const {
        return test::bridgeCommand("bonemill_bridge_force_dimension", library, words, record_file_, more);
    }
    // The force was zeroed, switched off, and the arm stopped and closed, in this order and last.
    void expectStopped() {
        const auto& calls = record();
        ASSERT_GE(calls.size(), 4u);
        const size_t n = calls.size();
        EXPECT_EQ(calls[n - 4].name, "force");
        EXPECT_EQ(calls[n - 4].forceNorm(), 0);
        EXPECT_EQ(calls[n - 3].name, "enable");
        EXPECT_EQ(calls[n - 3].values.at(0), 0);
        EXPECT_EQ(calls[n - 2].name, "stop");
        EXPECT_EQ(calls[n - 1].name, "close");
    }
};

TEST_F(ForceDimensionBridge, GivesTheCommandedWrenchInTheAxesOfTheSdkAndStops) {
    test::Process bridge(command(""));
    BridgeHost host(bridge);
    host.runPeriods(100);
    EXPECT_EQ(test::countOf(record(), "enable"), 0) << "nobody has enabled anything";
    EXPECT_GT(test::countOf(record(), "force"), 0) << "zero flows from the beginning";
    ASSERT_TRUE(host.engage());
    EXPECT_STREQ(host.description().name, "omega.6");
    EXPECT_EQ(host.description().max_force, kOmegaForce);
    EXPECT_EQ(host.description().serial, 4711u);
    EXPECT_TRUE(host.state().inputs & wire::kInputHomed);
    EXPECT_TRUE(host.state().inputs & (1u << wire::kFirstButtonInput));
    // The SDK says (0.01, 0.02, 0.03) with x to the operator, y right, z up.
    EXPECT_NEAR(host.state().p_DT[0], -0.02, 1e-12);
    EXPECT_NEAR(host.state().p_DT[1], 0.01, 1e-12);
    EXPECT_NEAR(host.state().p_DT[2], 0.03, 1e-12);
    EXPECT_NEAR(host.state().q_DT[3], std::sin(M_PI / 12), 1e-3);
    EXPECT_TRUE(std::isnan(host.state().v_DT[0]));
    host.want(true, {1, 2, 3, 0.1f, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > std::sqrt(14) - 1e-6; }));
    const RecordedCall force = lastForce();
    EXPECT_NEAR(force.values[0], 2, 1e-5);   // D's y, towards the operator
    EXPECT_NEAR(force.values[1], -1, 1e-5);  // D's x points to the left
    EXPECT_NEAR(force.values[2], 3, 1e-5);
    EXPECT_EQ(force.torqueNorm(), 0) << "the wrist of an omega.6 has no motors";
    host.want(false);
    EXPECT_TRUE(host.runUntil(
        [&] { return record().back().name == "force" && test::countOf(record(), "enable") == 2; }));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, ScalesWhatIsTooLarge) {
    test::Process bridge(command("type=104 returns_2 status_length=13"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {30, 40, 0, 0, 0, 9});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > kOmegaForce - 1e-6; }));
    const RecordedCall force = lastForce();
    EXPECT_NEAR(force.values[0] / -force.values[1], 40.0 / 30.0, 1e-6) << "the direction stays";
    EXPECT_NEAR(force.values[5], 0.2, 1e-5);
    bridge.signal(SIGINT);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kOmegaForce, 0.2);
}

TEST_F(ForceDimensionBridge, FadesWhenTheHostIsSilentAndGoesOnWithZero) {
    test::Process bridge(command("returns_1 heap block_ms=0.2 takes_over skewed"));
    {
        BridgeHost host(bridge);
        ASSERT_TRUE(host.engage());
        host.want(true, {0, 0, 5, 0, 0, 0});
        ASSERT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > 5 - 1e-9; }));
    }
    EXPECT_TRUE(test::waitFor([&] { return lastForce().forceNorm() == 0; }));
    const int so_far = test::countOf(record(), "force");
    EXPECT_TRUE(test::waitFor([&] { return test::countOf(record(), "force") > so_far + 50; }));
    EXPECT_EQ(test::countOf(record(), "enable"), 1) << "the arm still balances its weight";
    int rises = 0;
    double before = 5;  // from the last whole force on, it only falls
    for (const RecordedCall& call : record()) {
        if (call.name != "force") continue;
        rises += call.forceNorm() > before + 1e-6;
        if (call.forceNorm() > 5 - 1e-9) rises = 0;
        before = call.forceNorm();
    }
    EXPECT_EQ(rises, 0);
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, ForgivesErrorsThatPass) {
    test::Process bridge(command("fails_from=400 fails_for=10"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil(
        [&] { return test::countOf(record(), "force") > 600 && lastForce().forceNorm() > 0.99; }));
    bridge.signal(SIGHUP);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, TellsOfErrorsThatLastAndRecovers) {
    test::Process bridge(command("fails_from=400 fails_for=300"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultSdk; }));
    EXPECT_EQ(host.drive(), DriveState::kFault);
    EXPECT_EQ(host.state().fault_code, 2u);
    EXPECT_EQ(lastForce().forceNorm(), 0);
    EXPECT_TRUE(host.runUntil([&] { return host.drive() == DriveState::kOperationEnabled; }));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, NaNIsNoPose) {
    test::Process bridge(command("nan_at=400"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultSdk; }));
    EXPECT_TRUE(std::isfinite(host.state().p_DT[0]));
    EXPECT_EQ(bridge.wait().exit_code, 1) << "an arm that says nothing of use for long is lost";
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, LeavesWithAReasonWhenTheArmIsUnplugged) {
    test::Process bridge(command("unplugged_at=400"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    host.runUntil([&] { return !bridge.isRunning(); });
    const test::Finished finished = bridge.wait();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.err.find("no longer answers"), std::string::npos) << finished.err;
    expectStopped();
    test::expectHarmless(record(), kOmegaForce);
}

TEST_F(ForceDimensionBridge, TellsThatTheArmSwitchedItsForceOff) {
    test::Process bridge(command("velocity_at=500"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    EXPECT_TRUE(host.runUntil(
        [&] { return (host.faults() & wire::kFaultOverSpeed) && host.state().fault_code == 2; }));
    EXPECT_NE(host.drive(), DriveState::kOperationEnabled);
}

TEST_F(ForceDimensionBridge, DoesNotEnableWithoutCalibration) {
    test::Process bridge(command("uncalibrated"));
    BridgeHost host(bridge);
    host.want(true, {1, 0, 0, 0, 0, 0});
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    host.runPeriods(200);
    expectNotEnabled(host);
}

class HangingBridge : public ForceDimensionBridge, public testing::WithParamInterface<const char*> {};

TEST_P(HangingBridge, EndsInTimeWithAStop) {
    test::Process bridge(command(GetParam()));
    BridgeHost host(bridge);
    host.want(true);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    const bool hangs_while_it_runs = std::string(GetParam()) != "stop_hangs";
    ASSERT_TRUE(host.runUntil([&] { return !hangs_while_it_runs || test::countOf(record(), "hangs") > 0; }));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 3);
    EXPECT_GT(test::countOf(record(), "stop"), 0);
    test::expectHarmless(record(), kOmegaForce);
}

INSTANTIATE_TEST_SUITE_P(Calls, HangingBridge, testing::Values("hangs_at=300", "stop_hangs"));

TEST_F(ForceDimensionBridge, CanBeEndedWhileTheLibraryHangsInOpening) {
    test::Process bridge(command("open_hangs"));
    ASSERT_TRUE(test::waitFor([&] { return bridge.errSoFar().find("SDK version") != std::string::npos; }));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 3);
}

TEST_F(ForceDimensionBridge, EndsByItselfWhenTheLibraryHangs) {
    test::Process bridge(command("hangs_at=100"));
    const test::Finished finished = bridge.wait();
    EXPECT_EQ(finished.exit_code, 3);
    EXPECT_NE(finished.err.find("has not returned for 2 s"), std::string::npos) << finished.err;
}

TEST_F(ForceDimensionBridge, ACrashIsALostLink) {
    for (const std::string word : {"abort_at=300", "crash_at=300"}) {
        test::Process bridge(command(word));
        BridgeHost host(bridge);
        host.want(true);
        EXPECT_TRUE(host.runUntil([&] { return !bridge.isRunning(); }));
        EXPECT_NE(bridge.wait().exit_code, 0);
    }
}

TEST_F(ForceDimensionBridge, ProbesWithoutForce) {
    const test::Finished finished = test::run(command("takes_over", {"--probe"}));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    for (const char* text :
         {"SDK version: 3.17.5.0", "omega.6, serial 4711", "lacks", "drdOpenID", "up to 12.00 N"})
        EXPECT_NE(finished.out.find(text), std::string::npos) << text << " in\n" << finished.out;
    expectStopped();
    test::expectHarmless(record(), 0);
}

TEST_F(ForceDimensionBridge, GoesWithoutOptionalFunctions) {
    test::Process bridge(command("status_length=12", {}, "libstand_in_drd_old.so"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    EXPECT_EQ(host.state().q_DT[0], 1);
    EXPECT_FALSE(host.description().abilities & kAbilityOrientation);
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
}

TEST_F(ForceDimensionBridge, SaysWhatIsNotThere) {
    const auto messageOf = [&](const std::vector<std::string>& words) {
        const test::Finished finished = test::run(words);
        EXPECT_EQ(finished.exit_code, 2);
        return finished.err;
    };
    const auto expectIn = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    };
    expectIn(messageOf(command("", {}, "")), "library: libdrd.so.3 was not found in");
    expectIn(messageOf(command("", {}, "libnowhere.so")), "libnowhere.so does not exist");
    const std::string dependency = messageOf(command("", {}, "libstand_in_incomplete.so"));
    expectIn(dependency, "dependency: ");
    expectIn(dependency, "libstand_in_gone.so: cannot open shared object file");
    expectIn(messageOf(command("", {}, "libstand_in_drd_broken.so")),
             "lacks dhdSetForceAndTorqueAndGripperForce");
    expectIn(messageOf(command("major=2")), "is version 2.17.5.0 of the SDK");
    expectIn(messageOf(command("no_device")), "device: ");
    expectIn(messageOf(command("open_fails")), "error 2, communication error");
    expectIn(messageOf(command("", {"--device", "3"})), "the SDK sees 1 arms");
}

TEST_F(ForceDimensionBridge, TestsItselfAndPushesOnlyAfterAYes) {
    std::string line;
    for (const std::string& word : command("", {"--self-test", "--seconds", "0.3", "--ramp"}))
        line += " " + word;
    const test::Finished refused = test::run({"/bin/sh", "-c", "echo no |" + line});
    EXPECT_EQ(refused.exit_code, 2);
    test::expectHarmless(record(), 0);
    const test::Finished finished = test::run({"/bin/sh", "-c", "echo yes |" + line});
    EXPECT_EQ(finished.exit_code, 0) << finished.err << finished.out;
    EXPECT_NE(finished.out.find("passed"), std::string::npos);
    EXPECT_NE(finished.out.find("rate: "), std::string::npos);
    test::expectHarmless(record(), 0.5);
    double largest = 0;
    for (const RecordedCall& call : record())
        if (call.name == "force") largest = std::max(largest, call.values[2]);
    EXPECT_GT(largest, 0.4);
    expectStopped();
}

}  // namespace
}  // namespace bonemill
