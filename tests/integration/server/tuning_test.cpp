// The contact law of a live session is tuned by command: haptic_server, device_daemon and render_client are
// processes, the test itself is a viewer.
#include <gtest/gtest.h>
#include <signal.h>

#include "common/config/live_fields.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::run;

// The simulated hand presses the burr into a slab (top at z = 2 mm) for as long as a test takes.
class Tuning : public testing::Test {
  protected:
    Tuning() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        const auto waypoint = [](double time_s, double z_mm) {
            return "  waypoint { time_s: " + std::to_string(time_s) +
                   " p_WT_mm { x: 0 y: 0.1 z: " + std::to_string(z_mm) +
                   " } q_WT { w: 0.70710678 x: 0.70710678 } }\n";
        };
        test::writeFile(folder_ / "s.textproto",
                        "name: \"tuning\" volume { path: \"slab.nrrd\" } coupling { max_force_n: 20 }\n"
                        "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                        "simulated_operator {\n" +
                            waypoint(0, 3.6) + waypoint(1, 2) + waypoint(300, 2) + "}\n");
    }
    std::vector<std::string> server(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"haptic_server", "--scene",     folder_ / "s.textproto",
                                       "--session",     session(),     "--domain",
                                       domain(),        "--recording", folder_ / "recordings"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon",         "--device",  "simulated", "--scene",
                folder_ / "s.textproto", "--session", session()};
    }
    static Finished tune(const std::string& values, const std::string& role = "instructor") {
        return run({"render_client", "--command", "tune " + values, "--role", role, "--session", session(),
                    "--domain", domain()});
    }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }

    const topics::Status& status() { return *probe_.subscriber.status(); }
    double force() const {
        const auto& tool = probe_.subscriber.toolState();
        return tool ? Eigen::Map<const Eigen::Vector3d>(tool->force_n().data()).norm() : 0;
    }
    bool presses() {
        return probe_.pollUntil([&] { return probe_.subscriber.status() && force() > 0.3; });
    }
    std::string newestJournal() const {
        std::filesystem::path newest;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "recordings"))
            if (newest.empty() || entry.last_write_time() >= last_write_time(newest)) newest = entry.path();
        return newest;
    }

    test::TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(Tuning, AnInstructorsOrderIsFeltShownAndRunsAgainToTheBit) {
    Process server_process(server());
    Process daemon_process(daemon());
    ASSERT_TRUE(presses()) << daemon_process.errSoFar();
    ASSERT_TRUE(probe_.pollUntil([&] { return status().session_s() > 2; }));
    const double before = force();
    EXPECT_EQ(probe_.subscriber.sceneInfo()->tunable().coupling().max_force_n(), 20);

    const Finished refused = tune("coupling { max_force_n: 1 }", "operator");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(
        refused.out,
        "tune coupling { max_force_n: 1 }: refused: only an instructor may that (docs/howto/security.md)\n");
    const Finished beyond = tune("coupling { max_force_n: 21 }");
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_NE(beyond.out.find("is above what the scene file says (20)"), std::string::npos) << beyond.out;
    EXPECT_FALSE(status().has_tuning());

    const Finished done = tune("coupling { translation_stiffness_n_per_mm: 0.5 }");
    EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
    EXPECT_EQ(done.out, "tune coupling { translation_stiffness_n_per_mm: 0.5 }: done\n");
    ASSERT_TRUE(probe_.pollUntil([&] { return status().has_tuning(); }));
    EXPECT_EQ(tuningText(status().tuning()), "coupling { translation_stiffness_n_per_mm: 0.5 }");
    EXPECT_TRUE(probe_.pollUntil([&] { return force() < 0.8 * before; })) << before << ", " << force();

    EXPECT_EQ(tune("scene").exit_code, 0);
    ASSERT_TRUE(probe_.pollUntil([&] { return !status().has_tuning(); }));
    EXPECT_TRUE(probe_.pollUntil([&] { return force() > 0.95 * before; })) << before << ", " << force();
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
    const Finished verdict = run({"bonemill_lab", "session", "verify", newestJournal()});
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
    EXPECT_NE(verdict.out.find("the same bits"), std::string::npos) << verdict.out;
}

TEST_F(Tuning, ASessionThatWasKilledGoesOnAsItWasTuned) {
    uint64_t killed = 0;  // epoch
    {
        Process server_process(server());
        Process daemon_process(daemon());
        ASSERT_TRUE(presses()) << daemon_process.errSoFar();
        EXPECT_EQ(tune("coupling { max_force_n: 3 }").exit_code, 0);
        const double tuned_s = status().session_s();
        ASSERT_TRUE(probe_.pollUntil([&] { return status().session_s() > tuned_s + 1; }));
        killed = status().epoch();
        server_process.signal(SIGKILL);
        server_process.wait();
    }
    Process resumed(server({"--resume"}));
    Process daemon_process(daemon());
    ASSERT_TRUE(probe_.pollUntil([&] {
        return status().epoch() != killed && status().session_s() > 0.5 && status().has_tuning();
    })) << resumed.errSoFar();
    EXPECT_EQ(tuningText(status().tuning()), "coupling { max_force_n: 3 }");
    EXPECT_NE(resumed.errSoFar().find("goes on from tick"), std::string::npos) << resumed.errSoFar();
    resumed.signal(SIGTERM);
    EXPECT_EQ(resumed.wait().exit_code, 0);
    const Finished verdict = run({"bonemill_lab", "session", "verify", newestJournal()});
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
}

}  // namespace
}  // namespace bonemill
