// The accuracy of a live session is switched by command: haptic_server, device_daemon and render_client are
// processes, the test itself is a viewer.
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <set>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::run;
using test::TemporaryFolder;
using test::writeFile;

// A busy machine causes these on its own.
// A tick that came late leaves milling to the next one.
constexpr uint32_t kFaultsOfTheMachine =
    kFaultOverrun | kFaultStaleDevice | kFaultFewerSamples | kFaultMillingCutShort;

// The simulated hand pushes the burr into a slab (top at z = 2 mm) for as long as the test takes: 0.5 mm deep
// without milling, or slowly down through it.
class AccuracySwitching : public testing::Test {
  protected:
    AccuracySwitching() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
    }
    void writeScene(const std::string& accuracy, bool removes) const {
        const auto waypoint = [&](double time_s, double z_mm, bool is_removing) {
            return "  waypoint { time_s: " + std::to_string(time_s) +
                   " p_WT_mm { x: 0 y: 0.1 z: " + std::to_string(z_mm) +
                   " } q_WT { w: 0.70710678 x: 0.70710678 } remove: " + (is_removing ? "true" : "false") +
                   " }\n";
        };
        const double end_mm = removes ? -1 : 2.5;  // of the burr's centre, 1 mm above its pole
        writeFile(folder_ / "s.textproto",
                  "name: \"switching\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
                  "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                  "accuracy { " +
                      accuracy + " }\nsimulated_operator {\n" + waypoint(0, 3.6, false) +
                      waypoint(1, 2.3, removes) + waypoint(removes ? 60 : 2, end_mm, removes) +
                      waypoint(300, end_mm, false) + "}\n");
    }
    std::vector<std::string> server() const {
        return {"haptic_server", "--scene",  folder_ / "s.textproto", "--session", session(), "--domain",
                domain(),        "--report", folder_ / "report.json"};
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon",         "--device",  "simulated", "--scene",
                folder_ / "s.textproto", "--session", session()};
    }
    static Finished setAccuracy(const std::string& name) {
        return run(
            {"render_client", "--command", "accuracy " + name, "--session", session(), "--domain", domain()});
    }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }

    const topics::Status& status() { return *probe_.subscriber.status(); }
    bool hasStatus() {
        return probe_.pollUntil([this] { return probe_.subscriber.status().has_value(); });
    }
    // The tool touches the bone or, which is faster than the tool states come, cuts it.
    bool meetsBone() {
        const double removed_mm3 = status().removed_mm3();
        return probe_.pollUntil([&] {
            const auto& tool = probe_.subscriber.toolState();
            return (tool && tool->contacts() > 0) || status().removed_mm3() > removed_mm3;
        });
    }
    // The preset is shown, and the loop ticks on with it, at the bone.
    void expectInForce(const std::string& preset) {
        EXPECT_TRUE(probe_.pollUntil([&] { return status().preset() == preset; }))
            << preset << ", " << status().preset();
        const uint64_t ticks = status().ticks();
        EXPECT_TRUE(probe_.pollUntil([&] { return status().ticks() > ticks + 100; })) << preset;
        EXPECT_TRUE(meetsBone()) << preset;
        EXPECT_EQ(status().preset(), preset);
    }
    // Goes through every preset by command, and back to the scene's own settings.
    void expectEveryPresetInContact(const std::string& of_scene) {
        Process server_process(server());
        Process daemon_process(daemon());
        ASSERT_TRUE(hasStatus());
        expectInForce(of_scene);
        const uint32_t faults_before = status().faults();
        for (const std::string preset : {"thesis_2012", "fast", "exact", "balanced", "proxy_3dof", "vps",
                                         "penalty_sdf", "constraint", "thesis_2012"}) {
            const Finished answer = setAccuracy(preset);
            EXPECT_EQ(answer.exit_code, 0) << answer.err;
            EXPECT_EQ(answer.out, "accuracy " + preset + ": done\n");
            expectInForce(preset);
        }
        EXPECT_EQ(setAccuracy("scene").exit_code, 0);
        expectInForce(of_scene);
        EXPECT_EQ(status().faults() & ~(faults_before | kFaultsOfTheMachine), 0u) << status().fault_text();
        server_process.signal(SIGTERM);
        const Finished finished = server_process.wait();
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
    }

    TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(AccuracySwitching, WhilePressing) {
    writeScene("", false);
    expectEveryPresetInContact("balanced");
}

TEST_F(AccuracySwitching, WhileMilling) {
    writeScene("preset: FAST iterations: 3", true);
    expectEveryPresetInContact("gradient s=1 samples 80 um/512 analytic float iterations=3 ccd");
    EXPECT_GT(nlohmann::json::parse(test::readFile(folder_ / "report.json"))["removed_voxels"].get<double>(),
              0);
}

TEST_F(AccuracySwitching, ShowsTheErrorOfTheSettingsInForceIfItWasMeasured) {
    writeScene("", false);
    writeFile(folder_ / "s.accuracy.json",
              R"({"settings": {"fast": {"force_error_percent": 2.5, "direction_error_deg": 0.75}}})");
    Process server_process(server());
    ASSERT_TRUE(hasStatus());
    EXPECT_EQ(status().preset(), "balanced");
    EXPECT_FALSE(status().has_accuracy_error());
    EXPECT_EQ(setAccuracy("fast").exit_code, 0);
    ASSERT_TRUE(probe_.pollUntil([&] { return status().preset() == "fast"; }));
    EXPECT_TRUE(status().has_accuracy_error());
    EXPECT_EQ(status().force_error_percent(), 2.5);
    EXPECT_EQ(status().force_direction_error_deg(), 0.75);
}

TEST_F(AccuracySwitching, RefusesAPresetThatThereIsNot) {
    writeScene("", false);
    Process server_process(server());
    Process daemon_process(daemon());
    ASSERT_TRUE(hasStatus());
    const Finished answer = setAccuracy("best");
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_EQ(answer.out,
              "accuracy best: refused: no preset is called 'best'; " + presetNames() + " or scene\n");
    expectInForce("balanced");
}

TEST_F(AccuracySwitching, RefusesWhatTheSceneDoesNotAllow) {
    writeScene("preset: FAST switchable: false", false);
    Process server_process(server());
    Process daemon_process(daemon());
    ASSERT_TRUE(hasStatus());
    const Finished answer = setAccuracy("exact");
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_EQ(answer.out, "accuracy exact: refused: the scene says accuracy.switchable: false\n");
    EXPECT_EQ(setAccuracy("scene").exit_code, 0) << "that is what it has";
    expectInForce("fast");
}

TEST_F(AccuracySwitching, WithoutAServerTheClientGivesUpWithAHint) {
    const Finished answer = run({"render_client", "--command", "accuracy fast", "--timeout-s", "1",
                                 "--session", session(), "--domain", domain()});
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_EQ(answer.out, "");
    EXPECT_NE(answer.err.find("is a haptic_server running"), std::string::npos) << answer.err;
}

}  // namespace
}  // namespace bonemill
