// The bridge to Haply's Inverse Service, as a process, with a stand-in for the service that makes trouble.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>

#include "common/device_messages/device_messages.h"
#include "tests/integration/bridge/bridge_host.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using test::RecordedCall;
using wire::DriveState;

constexpr double kHaplyForce = 5;  // N

class HaplyBridge : public test::BridgeTest {
  protected:
    // Starts the service and returns the bridge's command.
    std::vector<std::string> command(const std::string& words, const std::vector<std::string>& more = {}) {
        service_.emplace(std::vector<std::string>{
            "/usr/bin/env", "STAND_IN=" + words, "STAND_IN_RECORD=" + record_file_, "/usr/bin/python3",
            test::sourceDir() + "/tests/integration/bridge/stand_in_haply.py"});
        EXPECT_TRUE(test::waitFor([&] { return service_->outSoFar().ends_with('\n'); }))
            << service_->errSoFar();
        const std::string port = service_->outSoFar().substr(0, service_->outSoFar().find('\n'));
        std::vector<std::string> all{"--service-port", port};
        all.insert(all.end(), more.begin(), more.end());
        return test::bridgeCommand("bonemill_bridge_haply", "", "", record_file_, all);
    }
    void expectHarmless() {
        for (const RecordedCall& call : record()) {
            ASSERT_NE(call.name, "unknown");
            ASSERT_LE(call.forceNorm(), kHaplyForce + 1e-6);
        }
    }
    // The last command is no force, and the connection is closed.
    void expectStopped() {
        EXPECT_TRUE(test::waitFor([&] { return test::countOf(record(), "close") == 1; }));
        EXPECT_EQ(lastForce().forceNorm(), 0);
        expectHarmless();
    }

    std::optional<test::Process> service_;
};

TEST_F(HaplyBridge, GivesTheCommandedForceInTheAxesOfTheServiceAndStops) {
    test::Process bridge(command("partial fragments"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    host.runPeriods(100);
    EXPECT_EQ(test::countOf(record(), "session"), 1);
    EXPECT_EQ(test::countOf(record(), "force"), 0) << "nobody has enabled anything";
    ASSERT_TRUE(host.engage());
    EXPECT_STREQ(host.description().name, "Haply inverse3");
    EXPECT_EQ(host.description().serial, 0x049du);
    EXPECT_EQ(host.description().abilities, uint32_t(kAbilityForce));
    // The service says (10, -100, 180) mm with x right, y forward, z up; the middle is (0, -120, 150).
    EXPECT_NEAR(host.state().p_DT[0], -0.01, 1e-9);
    EXPECT_NEAR(host.state().p_DT[1], -0.02, 1e-9);
    EXPECT_NEAR(host.state().p_DT[2], 0.03, 1e-9);
    EXPECT_NEAR(host.state().v_DT[0], -0.1, 1e-6);
    EXPECT_EQ(host.state().w_DT[0], 0);
    host.want(true, {1, 2, 3, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > std::sqrt(14) - 1e-6; }));
    EXPECT_NEAR(lastForce().values.at(0), -1, 1e-5);
    EXPECT_NEAR(lastForce().values.at(1), -2, 1e-5);
    EXPECT_NEAR(lastForce().values.at(2), 3, 1e-5);
    host.want(true, {30, 40, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > kHaplyForce - 1e-6; }));
    EXPECT_NEAR(lastForce().values.at(1) / lastForce().values.at(0), 4.0 / 3.0, 1e-6);
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
}

TEST_F(HaplyBridge, FadesWhenTheHostIsSilentAndGoesOnWithZero) {
    test::Process bridge(command("delay_ms=2 old", {"--service-version", "3.4"}));
    {
        BridgeHost host(bridge);
        host.want(true, {0, 0, 3, 0, 0, 0});
        ASSERT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > 3 - 1e-6; }));
    }
    EXPECT_TRUE(test::waitFor([&] { return lastForce().forceNorm() == 0; }));
    const int so_far = test::countOf(record(), "force");
    EXPECT_TRUE(test::waitFor([&] { return test::countOf(record(), "force") > so_far + 30; }));
    EXPECT_EQ(test::countOf(record(), "session"), 0);
    bridge.signal(SIGINT);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
}

TEST_F(HaplyBridge, TakesOrientationAndButtonsOfAGrip) {
    for (const std::string grip : {"wired", "wireless"}) {
        test::Process bridge(command(grip));
        BridgeHost host(bridge);
        ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
        EXPECT_TRUE(host.description().abilities & kAbilityOrientation);
        // A quarter turn about the service's x, which is D's -x.
        EXPECT_NEAR(std::abs(host.state().q_DT[0]), std::sqrt(0.5), 1e-9);
        EXPECT_NEAR(host.state().q_DT[1] / host.state().q_DT[0], -1, 1e-9);
        EXPECT_TRUE(std::isnan(host.state().v_DT[0]));
        EXPECT_EQ(host.state().inputs >> wire::kFirstButtonInput, grip == "wired" ? 1u : 2u);
    }
}

TEST_F(HaplyBridge, DoesNotEnableWithoutCalibration) {
    test::Process bridge(command("uncalibrated"));
    BridgeHost host(bridge);
    host.want(true, {1, 0, 0, 0, 0, 0});
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    host.runPeriods(200);
    expectNotEnabled(host);
    EXPECT_EQ(test::countOf(record(), "force"), 0);
}

class TroubledHaplyBridge : public HaplyBridge, public testing::WithParamInterface<const char*> {};

TEST_P(TroubledHaplyBridge, LeavesWithAReason) {
    test::Process bridge(command(GetParam()));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultSdk; }));
    host.runUntil([&] { return !bridge.isRunning(); });
    const test::Finished finished = bridge.wait();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.err.find("no longer answers"), std::string::npos) << finished.err;
    expectHarmless();
}

INSTANTIATE_TEST_SUITE_P(Services, TroubledHaplyBridge,
                         testing::Values("silent_at=400", "closes_at=400", "unplugged_at=400",
                                         "nonsense_at=400"));

TEST_F(HaplyBridge, ForgivesAnswersWithoutSense) {
    test::Process bridge(command("garbage_at=10"));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.engage());
    host.want(true, {0, 0, 1, 0, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return lastForce().forceNorm() > 0.5; }));
    bridge.signal(SIGTERM);
    EXPECT_EQ(bridge.wait().exit_code, 0);
    expectStopped();
}

TEST_F(HaplyBridge, ProbesAndSaysWhatIsNotThere) {
    const test::Finished probe = test::run(command("", {"--probe"}));
    EXPECT_EQ(probe.exit_code, 0) << probe.err;
    EXPECT_NE(probe.out.find("Haply inverse3, serial 1181"), std::string::npos) << probe.out;
    EXPECT_EQ(test::countOf(record(), "force"), 0);
    const auto errorOf = [](const std::vector<std::string>& words) {
        const test::Finished finished = test::run(words);
        EXPECT_EQ(finished.exit_code, 2);
        return finished.err;
    };
    EXPECT_NE(errorOf(command("no_device")).find("device: the service has no arm"), std::string::npos);
    EXPECT_NE(errorOf(command("", {"--device", "0815"})).find("no arm 0815"), std::string::npos);
    std::vector<std::string> nobody = command("");
    service_.reset();
    const std::string error = errorOf(nobody);
    EXPECT_NE(error.find("library: no WebSocket at 127.0.0.1:"), std::string::npos) << error;
}

TEST_F(HaplyBridge, TestsItself) {
    const test::Finished finished = test::run(command("", {"--self-test", "--seconds", "0.3"}));
    // On a busy machine not every answer comes in time, which it then says.
    EXPECT_NE(finished.out.find("periods: "), std::string::npos) << finished.err << finished.out;
    EXPECT_NE(finished.out.find("calibrated: yes"), std::string::npos) << finished.out;
    EXPECT_EQ(test::countOf(record(), "force"), 0);
}

}  // namespace
}  // namespace bonemill
