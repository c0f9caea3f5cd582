// A scripted hand ends: it says so, begins again on whole bone, and makes way for the mouse of a viewer.
// haptic_server and device_daemon are processes, the test itself is that viewer.
#include <gtest/gtest.h>
#include <signal.h>

#include "common/device_messages/device_messages.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;
using test::run;

class AfterTheScript : public testing::Test {
  protected:
    // The hand mills a pit into the slab (top at z = 2 mm) and leaves it: 2.5 s.
    AfterTheScript() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        const auto waypoint = [](double time_s, double z_mm, bool removes) {
            return "  waypoint { time_s: " + std::to_string(time_s) +
                   " p_WT_mm { x: 0 y: 0.1 z: " + std::to_string(z_mm) +
                   " } q_WT { w: 0.70710678 x: 0.70710678 } remove: " + (removes ? "true" : "false") + " }\n";
        };
        test::writeFile(folder_ / "s.textproto",
                        "name: \"script\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
                        "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                        "simulated_operator {\n" +
                            waypoint(0, 3.6, false) + waypoint(0.5, 3.1, true) + waypoint(1.5, 2.5, true) +
                            waypoint(2, 3.6, false) + waypoint(2.5, 3.6, false) + "}\n");
    }
    std::vector<std::string> server() const {
        return {"haptic_server", "--scene", folder_ / "s.textproto", "--session",           session(),
                "--domain",      domain(),  "--recording",           folder_ / "recordings"};
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon",         "--device",  "simulated", "--hold",   "--scene",
                folder_ / "s.textproto", "--session", session(),   "--domain", domain()};
    }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }

    const topics::Status& status() { return *probe_.subscriber.status(); }
    bool hasEnded() {
        return probe_.pollUntil(
            [&] { return probe_.subscriber.status() && status().device().script().has_ended(); });
    }
    bool isUnderWay() {
        return probe_.pollUntil([&] { return !status().device().has_script(); });
    }
    std::string order(void (topics::Command::*set)(bool)) {
        topics::Command command;
        (command.*set)(true);
        return probe_.order(command);
    }
    std::string journal() const {
        return std::filesystem::directory_iterator(folder_ / "recordings")->path().string();
    }

    test::TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(AfterTheScript, TheHandBeginsAgainOnWholeBoneAndMillsAsMuch) {
    Process server_process(server());
    Process daemon_process(daemon());
    ASSERT_TRUE(probe_.pollUntil([&] { return probe_.subscriber.status() && status().removed_mm3() > 0; }))
        << daemon_process.errSoFar();
    EXPECT_EQ(order(&topics::Command::set_begin_again).substr(0, 7), "refused") << "it is at work";
    ASSERT_TRUE(hasEnded()) << daemon_process.errSoFar();
    const double removed_mm3 = status().removed_mm3();
    EXPECT_GT(removed_mm3, 0.05);

    for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(order(&topics::Command::set_begin_again), "done");
        ASSERT_TRUE(isUnderWay());
        EXPECT_TRUE(probe_.pollUntil([&] { return status().removed_mm3() == 0; })) << "the bone is whole";
        ASSERT_TRUE(hasEnded()) << daemon_process.errSoFar();
        // Times of the machine are in it: the bone goes by the millisecond.
        EXPECT_NEAR(status().removed_mm3(), removed_mm3, 0.1 * removed_mm3);
    }
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
    const auto verdict = run({"bonemill_lab", "session", "verify", journal()});
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
    EXPECT_NE(verdict.out.find("the same bits"), std::string::npos) << verdict.out;
}

TEST_F(AfterTheScript, TheMouseOfAViewerTakesOverAndTheScriptComesBack) {
    Process server_process(server());
    Process daemon_process(daemon());
    ASSERT_TRUE(hasEnded()) << daemon_process.errSoFar();
    const uint32_t faults = status().faults();
    EXPECT_EQ(order(&topics::Command::set_take_over), "done");
    ASSERT_TRUE(probe_.pollUntil([&] {
        return status().device().kind() == uint32_t(DeviceKind::kPointer) &&
               status().device().state() == uint32_t(SafetyState::kEngaged);
    })) << daemon_process.errSoFar();
    EXPECT_EQ(status().device().script().taken_over_by(), probe_.subscriber.sender());
    EXPECT_FALSE(status().device().script().has_ended());
    EXPECT_EQ(status().faults() & ~faults & kFaultStaleDevice, 0u) << "a hand that rests was there all along";

    // To where no script has been, over the slab, and there into it.
    const auto tool_comes_to = [&](const Eigen::Vector3d& p_W, uint32_t buttons, double within) {
        const Eigen::Quaterniond q(0.70710678, 0.70710678, 0, 0);
        return probe_.pollUntil([&] {
            probe_.subscriber.wantTool({p_W, q.normalized()}, buttons, 1);
            const auto& tool = probe_.subscriber.toolState();
            return tool && (Eigen::Map<const Eigen::Vector3d>(tool->p_wt_m().data()) - p_W).norm() < within;
        });
    };
    EXPECT_TRUE(tool_comes_to({1e-3, 1.1e-3, 5e-3}, 0, 1e-4));
    const double removed_mm3 = status().removed_mm3();
    EXPECT_TRUE(tool_comes_to({1e-3, 1.1e-3, 2.5e-3}, kButtonRemove, 4e-4));
    EXPECT_TRUE(probe_.pollUntil([&] { return status().removed_mm3() > removed_mm3; }));
    probe_.subscriber.letToolGo();

    EXPECT_EQ(order(&topics::Command::set_begin_again), "done");
    EXPECT_TRUE(probe_.pollUntil([&] {
        return status().removed_mm3() == 0 && status().device().kind() == uint32_t(DeviceKind::kAres);
    })) << daemon_process.errSoFar();
    EXPECT_TRUE(hasEnded()) << daemon_process.errSoFar();
    EXPECT_GT(status().removed_mm3(), 0);
    EXPECT_EQ(status().faults() & ~faults & kFaultStaleDevice, 0u);
    daemon_process.signal(SIGTERM);
    EXPECT_EQ(daemon_process.wait().exit_code, 0);
}

// What a person may hold stays in that person's hand: the daemon hears the order, and does nothing.
TEST_F(AfterTheScript, WithoutOneNobodyTakesOver) {
    Process server_process(server());
    std::vector<std::string> words = daemon();
    words[2] = "pointer";
    Process daemon_process(words);
    ASSERT_TRUE(probe_.pollUntil([&] {
        return probe_.subscriber.status() && status().device().state() == uint32_t(SafetyState::kEngaged);
    })) << daemon_process.errSoFar();
    for (const auto set : {&topics::Command::set_take_over, &topics::Command::set_begin_again})
        EXPECT_EQ(order(set),
                  "refused: no scripted hand has done all of its script (device_daemon --device simulated "
                  "--hold)");
    EXPECT_FALSE(status().device().has_script());
}

}  // namespace
}  // namespace bonemill
