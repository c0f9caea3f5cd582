// The program that the daemon starts for itself: how it comes, and that it never stays behind.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr char kWaitingScene[] = R"(
volume { path: "not_read_by_the_daemon.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 36000 p_WT_mm { z: -2 } phase: "press" }
})";

class DaemonChildTest : public testing::Test {
  protected:
    DaemonChildTest() { test::writeFile(scene_file_, kWaitingScene); }

    std::vector<std::string> daemonWords() const {
        return {"device_daemon",
                "--device",
                "simulated",
                "--scene",
                scene_file_,
                "--session",
                std::to_string(100000 + getpid())};
    }
    // Of all processes that were started with this test's scene; what has ended has no words any more.
    int running() const {
        int count = 0;
        for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
            const std::string words = test::readFile(entry.path() / "cmdline");
            count += words.find(scene_file_) != std::string::npos;
        }
        return count;
    }

    const test::TemporaryFolder folder_;
    const std::string scene_file_ = folder_ / "scene.textproto";
};

// It is killed before its child has begun to run, while that starts, and when it listens.
TEST_F(DaemonChildTest, OfADaemonThatIsKilledNothingStaysBehind) {
    for (const int after_ms : {0, 2, 5, 10, 20, 50, 100, 500}) {
        test::Process daemon(daemonWords());
        std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
        daemon.signal(SIGKILL);
        EXPECT_TRUE(test::waitFor([&] { return running() == 0; })) << after_ms << " ms";
    }
    test::Process daemon(daemonWords());
    ASSERT_TRUE(test::waitFor([&] { return running() == 2; })) << daemon.errSoFar();
    daemon.signal(SIGKILL);
    EXPECT_TRUE(test::waitFor([&] { return running() == 0; }));
}

TEST_F(DaemonChildTest, AProgramWhoseParentHasGoneEndsAtOnce) {
    const test::Finished finished =
        test::run({"ares_emulator", "--scene", scene_file_, "--end-with-parent", "999999999"});
    EXPECT_EQ(finished.exit_code, 128 + SIGTERM) << finished.err;
}

TEST_F(DaemonChildTest, IsStartedWithoutAFork) {
    std::vector<std::string> words = daemonWords();
    words[0] = test::binDir() + "/device_daemon";
    words.insert(words.begin(), {"/usr/bin/env", "LD_PRELOAD=" + test::helperDir() + "/libno_fork.so"});
    words.insert(words.end(), {"--wait-seconds", "0.1"});
    const test::Finished finished = test::run(words);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_NE(finished.err.find("no haptic_server has answered"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace bonemill
