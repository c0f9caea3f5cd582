// Runs deploy/bonemill with the real server and daemon: does a session survive the death of each, and does
// nothing of it survive the end?
#include <gtest/gtest.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <unistd.h>

#include <regex>

#include "common/ipc/link_place.h"
#include "tests/integration/deploy/bonemill_rig.h"
#include "tests/support/dds_session.h"

namespace bonemill {
namespace {

using test::BonemillRig;
using test::isGone;
using test::Process;
using test::waitFor;

// The hand hangs over a small slab for a minute.
class BonemillSession : public testing::Test {
  protected:
    BonemillSession() {
        rig_.useRealPrograms();
        EXPECT_EQ(test::run({"make_phantom", "body", "--kind", "slab", "--out", rig_.folder() / "slab.nrrd"})
                      .exit_code,
                  0);
        const std::string over_it = "p_WT_mm { x: 0 y: 0.1 z: 3.6 } q_WT { w: 0.70710678 x: 0.70710678 } }\n";
        test::writeFile(rig_.scene(),
                        "name: \"own\" volume { path: \"slab.nrrd\" }\n"
                        "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                        "simulated_operator {\n  waypoint { time_s: 0 " +
                            over_it + "  waypoint { time_s: 60 " + over_it + "}\n");
    }
    std::vector<std::string> startWords() const {
        return rig_.words({"start", rig_.scene(), "--session", session_, "--device", "simulated",
                           "--no-viewer", "--domain", std::to_string(testDomain())});
    }
    // Returns the process of this name that the session has now, or 0.
    int pidOf(const std::string& name) const {
        const std::string list = rig_.call({"list"}).out;
        std::smatch found;
        return std::regex_search(list, found, std::regex(name + " ([0-9]+)")) ? std::stoi(found[1]) : 0;
    }
    // Tells how often the server and the daemon have said that the other one is there.
    bool haveMet(const std::string& log, const std::string& words, long times) const {
        return waitFor([&] {
            const std::string text = logOf(log);
            const std::regex pattern(words);
            return std::distance(std::sregex_iterator(text.begin(), text.end(), pattern), {}) >= times;
        });
    }
    // There is one folder of logs, beside that of recordings, as soon as the session has come so far.
    std::string logOf(const std::string& name) const {
        const std::filesystem::path logs = rig_.folder() / "logs/bonemill";
        if (!exists(logs)) return "";
        for (const auto& folder : std::filesystem::directory_iterator(logs))
            if (const auto log = folder.path() / (name + ".log"); exists(log)) return test::readFile(log);
        return "";
    }

    BonemillRig rig_;
    const std::string session_ = std::to_string(testSession());
};

// In a home where no scene has its phantom.
TEST_F(BonemillSession, OneOrderMakesThePhantomOfAnotherSceneAndChangesToIt) {
    std::filesystem::create_symlink(test::binDir() + "/make_phantom", rig_.programFile("make_phantom"));
    const std::string domain = std::to_string(testDomain());
    Process session(rig_.words({"start", "minimal", "--session", session_, "--device", "simulated",
                                "--no-viewer", "--domain", domain}));
    ASSERT_TRUE(haveMet("device", "haptic_server answers", 1)) << session.outSoFar() << logOf("server");
    const std::string phantom = rig_.folder() / "data/bonemill/build/data/clay_block.nrrd";
    ASSERT_FALSE(std::filesystem::exists(phantom));
    const auto changed = test::run(
        {"render_client", "--command", "scene freeform", "--session", session_, "--domain", domain});
    EXPECT_EQ(changed.out, "scene freeform: done\n") << changed.err << logOf("server");
    EXPECT_TRUE(std::filesystem::exists(phantom));
    session.signal(SIGINT);
    EXPECT_EQ(session.wait().exit_code, 0) << session.errSoFar();
}

TEST_F(BonemillSession, GoesOnWhenServerOrDaemonIsKilledAndEndsInOrder) {
    Process session(startWords());
    ASSERT_TRUE(haveMet("device", "haptic_server answers", 1)) << session.errSoFar() << logOf("server");
    const int daemon = pidOf("device_daemon"), server = pidOf("haptic_server");
    kill(server, SIGKILL);
    ASSERT_TRUE(haveMet("server", "the device is there", 2)) << logOf("server");
    ASSERT_TRUE(haveMet("device", "haptic_server answers", 2)) << logOf("device");
    EXPECT_EQ(pidOf("device_daemon"), daemon);
    const int second_server = pidOf("haptic_server");
    EXPECT_NE(second_server, server);

    kill(daemon, SIGKILL);
    ASSERT_TRUE(haveMet("device", "haptic_server answers", 3)) << logOf("device");
    EXPECT_EQ(pidOf("haptic_server"), second_server);
    const int second_daemon = pidOf("device_daemon");

    session.signal(SIGTERM);
    const test::Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    EXPECT_TRUE(isGone(second_daemon) && isGone(second_server));
    EXPECT_NE(logOf("device").find("stopping: force ramps to zero"), std::string::npos) << logOf("device");
    EXPECT_NE(logOf("server").find(" dropped, faults: "), std::string::npos) << logOf("server");
}

// It has made the link, and the server has not come yet that would have removed it.
TEST_F(BonemillSession, ADaemonThatIsKilledAloneLeavesNoMemory) {
    std::filesystem::remove(rig_.programFile("haptic_server"));  // no link to write through
    rig_.putProgram("haptic_server", test::kStandIn);
    const key_t key = linkKeyOf(testSession());
    Process session(startWords());
    ASSERT_TRUE(waitFor([&] { return shmget(key, 0, 0) >= 0; })) << logOf("device");
    kill(pidOf("device_daemon"), SIGKILL);
    session.signal(SIGTERM);
    session.wait();
    EXPECT_LT(shmget(key, 0, 0), 0);
    EXPECT_LT(semget(key, 0, 0), 0);
}

TEST_F(BonemillSession, EndsWithTheScriptThatIsKilled) {
    Process session(startWords());
    ASSERT_TRUE(haveMet("device", "haptic_server answers", 1)) << session.errSoFar() << logOf("server");
    const int daemon = pidOf("device_daemon"), server = pidOf("haptic_server");
    session.signal(SIGKILL);
    EXPECT_TRUE(waitFor([&] { return isGone(daemon) && isGone(server); }));
    EXPECT_NE(logOf("device").find("stopping: force ramps to zero"), std::string::npos) << logOf("device");
}

}  // namespace
}  // namespace bonemill
