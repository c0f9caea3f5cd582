// Runs the program itself: exit codes, messages, and a whole scenario against a server made of one thread.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

struct Outcome {
    int exit_code;
    std::string output;  // stdout and stderr
};

Outcome runDaemon(const std::string& arguments) {
    const std::string command = test::binDir() + "/device_daemon " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    Outcome outcome{-1, ""};
    std::array<char, 4096> part;
    while (const size_t n = fread(part.data(), 1, part.size(), pipe)) outcome.output.append(part.data(), n);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    return outcome;
}

class DeviceDaemonTest : public testing::Test {
  protected:
    DeviceDaemonTest() { std::filesystem::create_directories(folder_); }
    ~DeviceDaemonTest() override { std::filesystem::remove_all(folder_); }

    std::string sceneFile(const std::string& text) const {
        const std::filesystem::path file = folder_ / "scene.textproto";
        std::ofstream(file) << text;
        return file.string();
    }

    // The number differs between tests that run at the same time.
    const uint32_t session_ = 100000 + uint32_t(getpid());

  private:
    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("device_daemon_test_" + std::to_string(getpid()));
};

constexpr char kShortScene[] = R"(
volume { path: "not_read_by_the_daemon.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 0.2 p_WT_mm { z: -2 } phase: "press" }
  waypoint { time_s: 0.5 p_WT_mm { z: -2 } phase: "done" }
})";

struct Served {
    uint64_t answers = 0;
    uint32_t last_flags = 0;
};

// Answers every sample with a spring that resists z < 0 of the handle, until told to stop.
Served serveWall(uint32_t session, std::future<void> stop) {
    DeviceLink link = DeviceLink::create(DeviceLink::nameOfSession(session), LinkSide::kServer);
    Served served;
    while (stop.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        DeviceSample sample;
        if (!link.waitForSample(monotonicNowNs() + 10 * kNsPerMillisecond) || !link.readSample(sample))
            continue;
        WrenchCommand command{};
        command.stamp_ns = monotonicNowNs();
        command.answers_sequence = sample.sequence;
        command.f_hand_D[2] = sample.p_DT[2] < 0 ? -1000 * sample.p_DT[2] : 0;
        link.writeCommand(command);
        ++served.answers;
    }
    DeviceSample last{};
    if (link.readSample(last)) served.last_flags = last.flags;
    return served;
}

TEST_F(DeviceDaemonTest, PlaysTheScenarioWithAServerAndLeaves) {
    std::promise<void> stop;
    auto server = std::async(std::launch::async, serveWall, session_, stop.get_future());
    const Outcome outcome = runDaemon("--scene " + sceneFile(kShortScene) + " --best-effort-rt --session " +
                                      std::to_string(session_) + " --wait-seconds 60");
    stop.set_value();
    const Served served = server.get();
    EXPECT_GT(served.answers, 50u);
    EXPECT_TRUE(served.last_flags & kDeviceFlagLeaving);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const char* phase :
         {"phase approach", "phase press", "\"final_phase\":\"done\"", "\"failed_poses\":0"}) {
        EXPECT_NE(outcome.output.find(phase), std::string::npos) << phase << " in " << outcome.output;
    }
}

TEST_F(DeviceDaemonTest, GivesUpWithoutAServer) {
    const Outcome outcome = runDaemon("--scene " + sceneFile(kShortScene) + " --best-effort-rt --session " +
                                      std::to_string(session_) + " --wait-seconds 0.1");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("error: no haptic_server"), std::string::npos) << outcome.output;
}

TEST_F(DeviceDaemonTest, RefusesBadScenes) {
    const std::string volume = "volume { path: \"x\" } ";
    const std::pair<std::string, const char*> cases[] = {
        {sceneFile(volume + "device { link_lenght_mm: 3 }"), "link_lenght_mm"},
        {"/does/not/exist.textproto", "/does/not/exist.textproto"},
    };
    for (const auto& [file, name] : cases) {
        const Outcome outcome = runDaemon("--best-effort-rt --scene " + file);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
        EXPECT_EQ(outcome.output.rfind("error: ", 0), 0u) << outcome.output;
        EXPECT_NE(outcome.output.find(name), std::string::npos) << outcome.output;
    }
    const Outcome outside =
        runDaemon("--best-effort-rt --scene " +
                  sceneFile(volume + "simulated_operator { waypoint { p_WT_mm { x: 500 } } }"));
    EXPECT_EQ(outside.exit_code, 2);
    EXPECT_NE(outside.output.find("waypoint[0]"), std::string::npos) << outside.output;
}

TEST_F(DeviceDaemonTest, RefusesBadOptions) {
    for (const char* arguments : {"", "--scene", "--scene x --seconds -1", "--scene x --nonsense"}) {
        const Outcome outcome = runDaemon(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << arguments << ": " << outcome.output;
        EXPECT_EQ(outcome.output.rfind("error: ", 0), 0u) << outcome.output;
    }
    EXPECT_EQ(runDaemon("--help").exit_code, 0);
}

}  // namespace
}  // namespace bonemill
