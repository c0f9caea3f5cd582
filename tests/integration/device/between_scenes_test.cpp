// device_daemon follows haptic_server from scene to scene; here the test is the server, and the motors are
// those of an emulator.
#include <gtest/gtest.h>
#include <signal.h>

#include "common/device_messages/device_state.h"
#include "tests/integration/device/scene_announcer.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;
using test::waitFor;

class BetweenScenes : public testing::Test {
  protected:
    BetweenScenes() : server_(testSession()) {
        writeScene("a", 2);
        writeScene("b", 3);
        server_.announce(folder_ / "a.textproto");
    }
    void writeScene(const std::string& name, int base_z_mm) const {
        const std::string upright = "w: 0.70710678 x: 0.70710678";
        test::writeFile(folder_ / (name + ".textproto"),
                        "volume { path: \"none.nrrd\" } device { p_WD_mm { x: 0 y: 0.1 z: " +
                            std::to_string(base_z_mm) + " } q_WD { " + upright +
                            " } }\nsimulated_operator { waypoint { time_s: 0 p_WT_mm { x: 0 y: 0.1 z: 3.4 } "
                            "q_WT { " +
                            upright + " } } }\n");
    }
    std::vector<std::string> daemon(const std::string& device) const {
        return {"device_daemon", "--device",     device,      "--no-enabling-switch",       "--hold",
                "--stop-dir",    folder_.path(), "--session", std::to_string(testSession())};
    }
    bool comesTo(SafetyState state) {
        return waitFor([&] { return server_.sample().state == uint32_t(state); });
    }

    const test::TemporaryFolder folder_;
    test::SceneAnnouncer server_;
};

TEST_F(BetweenScenes, AStopStaysUntilSomebodyResetsTheDevice) {
    Process emulator({"ares_emulator", "--scene", folder_ / "a.textproto", "--hold", "--watchdog-ms", "30",
                      "--fault", "emergency-stop@0.2+0.2"});
    std::string said;
    ASSERT_TRUE(waitFor([&] {
        said = emulator.outSoFar();
        return said.find('\n') != std::string::npos || !emulator.isRunning();
    }));
    ASSERT_NE(said, "") << emulator.errSoFar();
    const size_t colon = said.find(':', said.find("listening on "));
    const std::string port = std::to_string(std::stoi(said.substr(colon + 1)));
    Process daemon_process(daemon("ares:127.0.0.1:" + port));
    ASSERT_TRUE(comesTo(SafetyState::kEmergencyStop)) << daemon_process.errSoFar();
    server_.announce(folder_ / "b.textproto");
    ASSERT_TRUE(waitFor([&] { return server_.sample().sequence != 0; })) << daemon_process.errSoFar();
    for (int n = 0; n < 30; ++n) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ASSERT_EQ(server_.sample().state, uint32_t(SafetyState::kEmergencyStop));
    }
    EXPECT_EQ(server_.sample().stop_cause, uint32_t(StopCause::kEmergencyStop));
    // Its chain may still be open: a reset before is none.
    EXPECT_TRUE(waitFor(
        [&] {
            ++server_.reset_orders;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            return server_.sample().reset_count > 0;
        },
        std::chrono::seconds(20)))
        << server_.sample().state << daemon_process.errSoFar();
    EXPECT_NE(server_.sample().state, uint32_t(SafetyState::kEmergencyStop));
}

TEST_F(BetweenScenes, WhoEndsThereSaysGoodbye) {
    Process daemon_process(daemon("simulated"));
    ASSERT_TRUE(comesTo(SafetyState::kEngaged)) << daemon_process.errSoFar();
    server_.announce(folder_ / "none.textproto", 1);
    ASSERT_TRUE(waitFor([&] {
        return daemon_process.errSoFar().find("none.textproto: scene file not found") != std::string::npos;
    })) << daemon_process.errSoFar();
    EXPECT_FALSE(server_.hasDeviceLeft());
    daemon_process.signal(SIGTERM);
    EXPECT_EQ(daemon_process.wait().exit_code, 0);
    EXPECT_TRUE(waitFor([&] { return server_.hasDeviceLeft(); }, std::chrono::seconds(2)));
}

}  // namespace
}  // namespace bonemill
