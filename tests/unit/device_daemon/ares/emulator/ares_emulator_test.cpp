// The program as a whole, driven through a real socket by the device that device_daemon uses.
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "common/rt/clock.h"
#include "common/rt/realtime.h"
#include "device_daemon/ares/driver/udp_device.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr char kShortScene[] = R"(
volume { path: "not_read_by_the_emulator.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 0.2 p_WT_mm { z: -2 } phase: "press" }
  waypoint { time_s: 0.4 p_WT_mm { z: -2 } phase: "done" }
})";
constexpr char kLongScene[] = R"(
volume { path: "not_read_by_the_emulator.nrrd" }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2 } phase: "approach" }
  waypoint { time_s: 36000 p_WT_mm { z: -2 } phase: "press" }
})";

// However busy this machine is, so long the link lasts.
constexpr uint32_t kPatientWatchdogUs = wire::kLongestWatchdogUs;

class AresEmulatorTest : public testing::Test {
  protected:
    std::unique_ptr<test::Process> start(const char* scene, const std::vector<std::string>& more = {}) {
        const std::string file = folder_.path() / "scene.textproto";
        test::writeFile(file, scene);
        std::vector<std::string> words{"ares_emulator", "--scene", file};
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<test::Process>(words);
    }

  private:
    const test::TemporaryFolder folder_;
};

// Reads where the program listens from its first line.
wire::Endpoint placeOf(const test::Process& process) {
    const std::string kWords = "listening on 127.0.0.1:";
    std::string line;
    EXPECT_TRUE(test::waitFor([&] {
        line = process.outSoFar();
        return line.find('\n') != std::string::npos;
    })) << process.errSoFar();
    EXPECT_EQ(line.rfind(kWords, 0), 0u) << line;
    return {wire::kLoopback, uint16_t(std::stoi(line.substr(kWords.size())))};
}

// The calling thread keeps its deadlines while this lives, where the machine grants that, as the loop of
// device_daemon does. What it starts meanwhile would inherit it.
class Punctual {
  public:
    Punctual() { makeThreadRealtime({}); }
    ~Punctual() {
        const sched_param none{};
        pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
    }
    Punctual(const Punctual&) = delete;
    Punctual& operator=(const Punctual&) = delete;
};

// A host that lets the hand feel it whenever the switch is held, and resets when asked to.
class Host {
  public:
    explicit Host(const wire::Endpoint& controller)
        : device_({.controller = controller, .watchdog_us = kPatientWatchdogUs}) {}

    // One period; true says that the device was heard.
    bool period() {
        device_.waitForSample(monotonicNowNs() + 2 * kNsPerMillisecond);
        const bool is_heard = device_.readJoints(1e-3, reading);
        const bool is_ready = is_heard && reading.fault == StopCause::kNone && is_wanted;
        is_engaged = is_ready && (reading.status & kStatusEnabled) && (reading.status & kStatusDriving) &&
                     (reading.status & kStatusCalibrated);
        device_.applyForces({.forces = Vector6d::Constant(is_engaged ? force : 0),
                             .is_wanted = is_ready,
                             .is_engaged = is_engaged,
                             .reset = is_heard && (reading.status & kStatusResetPressed)});
        return is_heard;
    }
    // Runs until the condition holds; the limit ends a test that hangs.
    bool runUntil(const std::function<bool()>& condition) {
        const int64_t end_ns = monotonicNowNs() + 200 * kNsPerSecond;
        while (monotonicNowNs() < end_ns) {
            is_heard = period();
            if (condition()) return true;
        }
        return false;
    }
    const UdpJointDevice& device() const { return device_; }

    JointReading reading;
    bool is_heard = false;
    bool is_engaged = false;
    bool is_wanted = true;
    double force = 0;

  private:
    const Punctual punctual_;
    UdpJointDevice device_;
};

nlohmann::json lastLineOf(const std::string& out) {
    const size_t end = out.find_last_not_of('\n');
    const size_t begin = out.rfind('\n', end) + 1;
    return nlohmann::json::parse(out.substr(begin, end + 1 - begin));
}

TEST_F(AresEmulatorTest, IsDescribedEnabledMovedAndLeavesAtTheEndOfItsScenario) {
    const auto emulator = start(kShortScene);
    Host host(placeOf(*emulator));
    ASSERT_TRUE(host.runUntil([&] { return host.is_heard; }));
    const double q_begin = host.reading.q[0];
    ASSERT_TRUE(host.runUntil([&] { return host.is_engaged; }));
    ASSERT_TRUE(host.device().description());
    EXPECT_STREQ(host.device().description()->name, "ARES emulator");
    EXPECT_EQ(host.device().description()->kind, uint32_t(DeviceKind::kAres));
    EXPECT_EQ(host.device().description()->watchdog_us, kPatientWatchdogUs);
    ASSERT_TRUE(host.runUntil([&] { return bool(host.reading.status & kStatusLeaving); }));
    EXPECT_NEAR(host.reading.q[0], q_begin - 4e-3, 1e-3);
    host.is_wanted = false;
    host.runUntil([&] { return !host.is_heard; });

    const test::Finished finished = emulator->wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const nlohmann::json said = lastLineOf(finished.out);
    EXPECT_EQ(said["final_phase"], "done");
    EXPECT_GE(said["scenario_s"], 0.4);
    EXPECT_GT(said["packets_received"], 400);
    EXPECT_GT(said["packets_sent"], 400);
    EXPECT_NE(finished.err.find("phase press"), std::string::npos) << finished.err;
}

TEST_F(AresEmulatorTest, FindsItsZeroBeforeItCanBeUsed) {
    const auto emulator = start(kLongScene, {"--unhomed"});
    Host host(placeOf(*emulator));
    ASSERT_TRUE(host.runUntil([&] { return bool(host.reading.status & kStatusHoming); }));
    EXPECT_FALSE(host.is_engaged);
    ASSERT_TRUE(host.runUntil([&] { return host.is_engaged; }));
    EXPECT_TRUE(host.reading.status & kStatusCalibrated);
}

TEST_F(AresEmulatorTest, TripsItsWatchdogWhenTheHostIsSilentAndGoesOnOnceReset) {
    const auto emulator = start(kLongScene);
    Host host(placeOf(*emulator));
    host.force = 2;
    // On a busy machine late packets may be the first fault; then it is tried again.
    do {
        ASSERT_TRUE(host.runUntil([&] { return host.is_engaged && host.reading.forces[0] > 1.5; }));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        ASSERT_TRUE(host.runUntil([&] { return host.is_heard && host.reading.fault != StopCause::kNone; }));
    } while (host.reading.fault == StopCause::kLatePackets);
    EXPECT_EQ(host.reading.fault, StopCause::kDeviceLost);
    EXPECT_EQ(host.reading.fault_code, wire::kFaultWatchdog);
    EXPECT_LT(host.reading.forces[0], 0.1);
    ASSERT_TRUE(host.runUntil([&] { return host.is_engaged; })) << "the hand presses the reset";
    emulator->signal(SIGTERM);
    host.is_wanted = false;
    host.runUntil([&] { return !host.is_heard; });
    const test::Finished finished = emulator->wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_GE(lastLineOf(finished.out)["watchdog_trips"], 1);
    EXPECT_EQ(lastLineOf(finished.out)["final_phase"], "approach");
}

TEST_F(AresEmulatorTest, IsFoundAgainAfterItWasUnplugged) {
    const auto emulator = start(kLongScene, {"--fault", "unplug@0.2+0.3"});
    Host host(placeOf(*emulator));
    ASSERT_TRUE(host.runUntil([&] { return host.is_engaged; }));
    ASSERT_TRUE(host.runUntil([&] { return !host.is_heard; }));
    ASSERT_TRUE(host.runUntil([&] { return host.is_engaged; }));
    EXPECT_GE(host.device().descriptionCount(), 2u);
}

TEST_F(AresEmulatorTest, GoesOnWithABadWire) {
    const auto emulator = start(kShortScene, {"--fault", "drop%1", "--fault", "duplicate%1", "--fault",
                                              "reorder%1", "--fault", "corrupt%1", "--seed", "9"});
    Host host(placeOf(*emulator));
    ASSERT_TRUE(host.runUntil([&] { return host.is_heard && (host.reading.status & kStatusLeaving); }));
    const test::Finished finished = emulator->wait();
    EXPECT_EQ(finished.exit_code, 0);
    const nlohmann::json said = lastLineOf(finished.out);
    EXPECT_GT(said["packets_rejected"], 0) << said;
    EXPECT_GT(said["packets_lost"], 0) << said;
    EXPECT_GT(said["packets_old"], 0) << said;
}

TEST_F(AresEmulatorTest, EndsAtASignalWithoutAHost) {
    for (const int number : {SIGTERM, SIGINT}) {
        const auto emulator = start(kLongScene, {"--rate", "4000"});
        placeOf(*emulator);
        emulator->signal(number);
        const test::Finished finished = emulator->wait();
        EXPECT_EQ(finished.exit_code, 0);
        EXPECT_EQ(lastLineOf(finished.out)["final_phase"], "waiting for device_daemon");
    }
}

TEST_F(AresEmulatorTest, RefusesBadOptions) {
    const std::vector<std::string> cases[] = {{"--fault", "nonsense"},
                                              {"--watchdog-ms", "1"},
                                              {"--watchdog-ms", "2", "--rate", "500"},
                                              {"--address", "here"},
                                              {"--nonsense"}};
    for (const std::vector<std::string>& words : cases) {
        const auto emulator = start(kLongScene, words);
        const test::Finished finished = emulator->wait();
        EXPECT_EQ(finished.exit_code, 2) << words.back();
        EXPECT_EQ(finished.err.rfind("error: ", 0), 0u) << finished.err;
    }
    EXPECT_EQ(test::run({"ares_emulator", "--help"}).exit_code, 0);
}

}  // namespace
}  // namespace bonemill
