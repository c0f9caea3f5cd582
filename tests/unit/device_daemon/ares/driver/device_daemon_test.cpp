// Runs the program itself: exit codes, messages, and a whole scenario against a server made of one thread.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "common/config/scene_file.h"
#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "tests/support/process.h"
#include "tests/unit/device_daemon/ares/driver/wire_controller.h"

namespace bonemill {
namespace {

class DeviceDaemonTest : public testing::Test {
  protected:
    std::string sceneFile(const std::string& text) const {
        const std::string file = folder_ / "scene.textproto";
        test::writeFile(file, text);
        return file;
    }
    // With further words after these.
    std::vector<std::string> commandLine(const std::string& scene_file,
                                         const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"device_daemon", "--scene", scene_file, "--session",
                                       std::to_string(session_)};
        words.insert(words.end(), more.begin(), more.end());
        if (std::find(more.begin(), more.end(), "--device") == more.end())
            words.insert(words.end(), {"--device", "simulated"});
        return words;
    }

    // The number differs between tests that run at the same time.
    const uint32_t session_ = 100000 + uint32_t(getpid());

  private:
    const test::TemporaryFolder folder_;
};

constexpr char kShortScene[] = R"(
volume { path: "not_read_by_the_daemon.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 0.2 p_WT_mm { z: -2 } phase: "press" }
  waypoint { time_s: 0.5 p_WT_mm { z: -2 } phase: "done" }
})";

// The first phase lasts longer than any test waits.
constexpr char kLongScene[] = R"(
volume { path: "not_read_by_the_daemon.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 36000 p_WT_mm { z: -2 } phase: "press" }
})";

// Answers every sample with a spring that resists z < 0 of the handle.
class WallServer {
  public:
    // With a scene file it says that this scene is in force.
    explicit WallServer(uint32_t session, const std::string& scene_file = "")
        : link_(DeviceLink::create(session, LinkSide::kServer)),
          revision_at_start_(scene_file.empty() ? 0 : announce(scene_file)),
          thread_([this](const std::stop_token& stop) {
              while (!stop.stop_requested()) answerNext();
          }) {}

    uint64_t answers() const { return answers_; }
    uint32_t announce(const std::string& scene_file) {
        return link_.announceScene(scene_file, sceneHashOf(loadScene(scene_file).scene));
    }
    // The newest sample is of a device of that scene.
    bool isFollowed(uint32_t revision) const { return sample_revision_ == revision; }
    // A sample has said that the device was stopped.
    bool hasSeenStop() const { return has_seen_stop_; }
    // Answers no more, and returns the flags of the newest sample.
    uint32_t end() {
        thread_ = {};
        DeviceSample newest{};
        return link_.readSample(newest) ? newest.flags : 0;
    }

  private:
    void answerNext() {
        DeviceSample sample;
        if (!link_.waitForSample(monotonicNowNs() + 10 * kNsPerMillisecond) || !link_.readSample(sample))
            return;
        if (sample.stop_cause != 0) has_seen_stop_ = true;
        sample_revision_ = sample.scene_revision;
        WrenchCommand command{};
        command.stamp_ns = monotonicNowNs();
        command.answers_sequence = sample.sequence;
        command.scene_revision = sample.scene_revision;
        command.f_hand_D[2] = sample.p_DT[2] < 0 ? -1000 * sample.p_DT[2] : 0;
        link_.writeCommand(command);
        ++answers_;
    }

    DeviceLink link_;
    uint32_t revision_at_start_;
    std::atomic<uint32_t> sample_revision_{0};
    std::atomic<uint64_t> answers_{0};
    std::atomic<bool> has_seen_stop_{false};
    std::jthread thread_;
};

// The word for --device, of a controller that is there first, as a real one would be.
std::string deviceOf(const test::Process& emulator) {
    const std::string begin = "listening on ";
    EXPECT_TRUE(test::waitFor([&] { return emulator.outSoFar().find('\n') != std::string::npos; }));
    const std::string said = emulator.outSoFar();
    return "ares:" + said.substr(begin.size(), said.find('\n') - begin.size());
}

std::string allOf(const test::Finished& finished) {
    return finished.out + finished.err;
}

// Where programs wait for a processor, packets come late or the device seems lost.
void expectNoStopsButOfABusyMachine(const test::Finished& finished) {
    std::istringstream lines(finished.err);
    for (std::string line; std::getline(lines, line);) {
        if (line.find(" error ") == std::string::npos) continue;
        EXPECT_TRUE(line.find("packets come late") != std::string::npos ||
                    line.find("device lost") != std::string::npos)
            << line;
    }
}

void expectSays(const test::Finished& finished, const std::string& text) {
    EXPECT_NE(allOf(finished).find(text), std::string::npos) << text << " in " << allOf(finished);
}

TEST_F(DeviceDaemonTest, PlaysTheScenarioWithAServerAndLeaves) {
    const std::string file = sceneFile(kShortScene);
    test::Process daemon(commandLine(file));
    WallServer server(session_);
    const test::Finished finished = daemon.wait();
    EXPECT_GT(server.answers(), 0u);
    EXPECT_TRUE(server.end() & kDeviceFlagLeaving);
    EXPECT_EQ(finished.exit_code, 0) << allOf(finished);
    expectSays(finished, "\"final_phase\":\"done\"");
    expectNoStopsButOfABusyMachine(finished);
}

TEST_F(DeviceDaemonTest, TakesTheServersSceneAndFollowsItsChange) {
    const std::string first = sceneFile(kLongScene);
    const test::TemporaryFolder elsewhere;
    const std::string second = elsewhere / "second.textproto";
    test::writeFile(second, kShortScene);
    std::vector<std::string> words = commandLine(first);
    words.erase(words.begin() + 1, words.begin() + 3);  // no --scene
    test::Process daemon(words);
    WallServer server(session_, first);
    ASSERT_TRUE(test::waitFor([&] { return server.isFollowed(1) && server.answers() > 50; }));
    EXPECT_EQ(server.announce(first), 2u);
    ASSERT_TRUE(test::waitFor([&] { return server.isFollowed(2); })) << "the same scene needs no change";
    EXPECT_EQ(daemon.errSoFar().find("changes to"), std::string::npos) << daemon.errSoFar();
    EXPECT_EQ(server.announce(second), 3u);
    const test::Finished finished = daemon.wait();
    EXPECT_TRUE(server.isFollowed(3));
    EXPECT_TRUE(server.end() & kDeviceFlagLeaving);
    EXPECT_EQ(finished.exit_code, 0) << allOf(finished);
    expectSays(finished, "haptic_server changes to " + second);
    expectSays(finished, "\"final_phase\":\"done\"");
}

TEST_F(DeviceDaemonTest, WaitsForASceneFileThatIsTheServers) {
    const std::string file = sceneFile(kShortScene);
    test::Process daemon(commandLine(file));
    DeviceLink server = DeviceLink::create(session_, LinkSide::kServer);
    server.announceScene(file, 12345);
    EXPECT_TRUE(test::waitFor([&] {
        return daemon.errSoFar().find("has changed since haptic_server read it") != std::string::npos;
    }));
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait().exit_code, 0);
}

// However seldom it runs, it has the time to get there.
TEST_F(DeviceDaemonTest, SaysTheFirstAndTheLastPhaseAndLeavesWhenToldTo) {
    struct {
        const char* scene;
        std::vector<std::string> options;
        std::string phase;
    } const cases[] = {{kLongScene, {}, "approach"}, {kShortScene, {"--hold"}, "done"}};
    for (const auto& [scene, options, phase] : cases) {
        const std::string file = sceneFile(scene);
        test::Process daemon(commandLine(file, options));
        WallServer server(session_);
        EXPECT_TRUE(test::waitFor([&, phase = phase] {
            const std::string said = daemon.outSoFar() + daemon.errSoFar();
            return said.find("phase " + phase) != std::string::npos && server.answers() > 50;
        })) << phase;
        daemon.signal(SIGTERM);
        const test::Finished finished = daemon.wait();
        EXPECT_TRUE(server.end() & kDeviceFlagLeaving) << phase;
        EXPECT_EQ(finished.exit_code, 0) << allOf(finished);
        expectSays(finished, "\"final_phase\":\"" + phase + "\"");
    }
}

TEST_F(DeviceDaemonTest, GivesUpWithoutAServer) {
    const test::Finished finished = test::run(commandLine(sceneFile(kShortScene), {"--wait-seconds", "0.1"}));
    EXPECT_EQ(finished.exit_code, 2);
    expectSays(finished, "error: no haptic_server has answered within 0.1 s:");
}

TEST_F(DeviceDaemonTest, WarnsOnceOfADeviceThatDoesNotAnswer) {
    const std::string warning = "warning the device does not answer: device_daemon --list says";
    const std::string file = sceneFile(kShortScene);
    const std::string silent = "gamepad:" + file;
    const test::Finished finished =
        test::run(commandLine(file, {"--device", silent, "--wait-seconds", "2.5"}));
    expectSays(finished, warning);
    EXPECT_EQ(finished.err.find(warning), finished.err.rfind(warning)) << finished.err;
    const test::Finished heard =
        test::run(commandLine(file, {"--device", "pointer", "--wait-seconds", "2.5"}));
    EXPECT_EQ(heard.err.find("does not answer"), std::string::npos) << heard.err;
}

TEST_F(DeviceDaemonTest, NamesTheFigureForWhichABridgeIsRefused) {
    wire::Describe description = test::testDescription();
    description.max_torque = -1;
    test::WireController<wire::PosePackets> bridge(description);
    const std::string device = "bridge:127.0.0.1:" + std::to_string(bridge.link.local().port);
    const std::jthread turns([&bridge](const std::stop_token& stop) {
        for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(1)))
            bridge.period();
    });
    const test::Finished finished =
        test::run(commandLine(sceneFile(kShortScene), {"--device", device, "--wait-seconds", "2.5"}));
    expectSays(finished, "warning the device is refused for the max_torque that it describes itself with:");
    EXPECT_EQ(finished.err.find("does not answer"), std::string::npos) << finished.err;
}

TEST_F(DeviceDaemonTest, RefusesBadScenes) {
    const std::string volume = "volume { path: \"x\" } ";
    const std::pair<std::string, const char*> cases[] = {
        {sceneFile(volume + "device { link_lenght_mm: 3 }"), "link_lenght_mm"},
        {"/does/not/exist.textproto", "/does/not/exist.textproto"},
    };
    for (const auto& [file, name] : cases) {
        const test::Finished finished = test::run(commandLine(file));
        EXPECT_EQ(finished.exit_code, 2) << allOf(finished);
        EXPECT_EQ(allOf(finished).rfind("error: ", 0), 0u) << allOf(finished);
        expectSays(finished, name);
    }
    const test::Finished outside =
        test::run(commandLine(sceneFile(volume + "simulated_operator { waypoint { p_WT_mm { x: 500 } } }")));
    EXPECT_EQ(outside.exit_code, 2);
    expectSays(outside, "waypoint[0]");
}

TEST_F(DeviceDaemonTest, RefusesAControllerThatHasNotTheAresOfTheScene) {
    const std::string other = std::string(kLongScene) + "device { stroke_mm: 140 max_actuator_force_n: 30 }";
    test::Process controller({"ares_emulator", "--scene", sceneFile(other)});
    const std::string device = deviceOf(controller);
    const test::Finished finished =
        test::run(commandLine(sceneFile(kLongScene), {"--device", device, "--wait-seconds", "20"}));
    EXPECT_EQ(finished.exit_code, 2);
    expectSays(finished, "error: the controller at " + device.substr(5));
    expectSays(finished, "its stroke is 140, field `device.stroke_mm` says 151");
    expectSays(finished, "largest actuator force is 30, field `device.max_actuator_force_n` says 50");
}

// It ends sooner than the file would be complete.
TEST_F(DeviceDaemonTest, WritesAStopThatCameJustBeforeItsEnd) {
    const test::TemporaryFolder stops;
    const std::string file = sceneFile(kLongScene);
    test::Process controller({"ares_emulator", "--scene", file, "--fault", "emergency-stop"});
    const std::string device = deviceOf(controller);
    test::Process daemon(commandLine(file, {"--device", device, "--stop-dir", stops.path()}));
    WallServer server(session_);
    ASSERT_TRUE(test::waitFor([&] {
        for (int i = 0; i < 20 && !server.hasSeenStop(); ++i) usleep(1000);
        return server.hasSeenStop();
    }));
    daemon.signal(SIGTERM);
    const test::Finished finished = daemon.wait();
    EXPECT_EQ(finished.exit_code, 0) << allOf(finished);
    const std::filesystem::directory_iterator files(stops.path());
    ASSERT_EQ(std::distance(begin(files), end(files)), 1) << allOf(finished);
    EXPECT_NE(test::readFile(std::filesystem::directory_iterator(stops.path())->path())
                  .find(",emergency stop,emergency stop,"),
              std::string::npos);
}

TEST_F(DeviceDaemonTest, RefusesBadOptions) {
    const std::vector<std::string> cases[] = {
        {"--describe"}, {"--scene"}, {"--scene", "x", "--seconds", "-1"}, {"--scene", "x", "--nonsense"}};
    for (std::vector<std::string> words : cases) {
        words.insert(words.begin(), "device_daemon");
        const test::Finished finished = test::run(words);
        EXPECT_EQ(finished.exit_code, 2) << allOf(finished);
        EXPECT_EQ(allOf(finished).rfind("error: ", 0), 0u) << allOf(finished);
    }
    EXPECT_EQ(test::run({"device_daemon", "--help"}).exit_code, 0);
}

}  // namespace
}  // namespace bonemill
