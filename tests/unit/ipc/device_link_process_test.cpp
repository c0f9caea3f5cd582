// Tries the link between real processes: start order, death and return.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "tests/unit/ipc/link_test_tools.h"

namespace bonemill {
namespace {

constexpr int kSuccess = 0;

// The child process runs `body` and leaves with its result; it is killed if the test ends first.
class Child {
  public:
    explicit Child(const std::function<int()>& body) : pid_(fork()) {
        if (pid_ == 0) {
            int result = 99;
            try {
                result = body();
            } catch (...) {
            }
            _exit(result);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() { kill(); }

    int exitCode() {
        int status = 0;
        waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        waitpid(std::exchange(pid_, -1), nullptr, 0);
    }

  private:
    pid_t pid_;
};

int64_t farAwayNs() {
    return monotonicNowNs() + 250 * kNsPerSecond;
}

DeviceSample restingSample() {
    DeviceSample sample{};
    sample.stamp_ns = monotonicNowNs();
    sample.q_DT[0] = 1.0;
    return sample;
}

int publishForever(const TestLinkName& name) {
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
    for (;;) {
        daemon.writeSample(restingSample());
        usleep(200);
    }
}

TEST(DeviceLinkProcesses, everySampleIsAnsweredAcrossProcesses) {
    constexpr uint64_t kSamples = 2000;
    const TestLinkName name;
    Child device([&] {
        DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
        for (uint64_t i = 1; i <= kSamples; ++i) {
            DeviceSample sample = restingSample();
            sample.p_DT[0] = double(i) / kSamples;
            daemon.writeSample(sample);
            WrenchCommand command{};
            while (command.answers_sequence < i) {
                if (!daemon.waitForCommand(farAwayNs()) || !daemon.readCommand(command)) return 1;
            }
            if (command.f_hand_D[2] != 2 * sample.p_DT[0]) return 2;
        }
        return kSuccess;
    });
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceSample sample{};
    while (sample.sequence < kSamples && server.waitForSample(farAwayNs()) && server.readSample(sample)) {
        ASSERT_TRUE(isPlausible(sample));
        WrenchCommand command{};
        command.f_hand_D[2] = 2 * sample.p_DT[0];
        command.answers_sequence = sample.sequence;
        server.writeCommand(command);
    }
    EXPECT_EQ(device.exitCode(), kSuccess);
}

TEST(DeviceLinkProcesses, bothMayStartAtTheSameMoment) {
    const TestLinkName name;
    for (int round = 0; round < 100; ++round) {
        Child device([&] {
            DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
            WrenchCommand command{};
            daemon.writeSample(restingSample());
            return daemon.waitForCommand(farAwayNs()) && daemon.readCommand(command) ? kSuccess : 1;
        });
        DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
        DeviceSample sample{};
        ASSERT_TRUE(server.waitForSample(farAwayNs()) && server.readSample(sample));
        server.writeCommand({});
        ASSERT_EQ(device.exitCode(), kSuccess) << round;
    }
}

TEST(DeviceLinkProcesses, aKilledDaemonIsNoticedAndMayReturn) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    uint64_t last_sequence = 0;
    for (int life = 0; life < 10; ++life) {
        Child device([&] { return publishForever(name); });
        DeviceSample sample{};
        for (int i = 0; i < 5; ++i) {
            ASSERT_TRUE(server.waitForSample(farAwayNs()));
            // It is false only if the last life ended in the middle of a write; the next write repairs that.
            if (!server.readSample(sample)) continue;
            ASSERT_TRUE(isPlausible(sample));
            ASSERT_GT(sample.sequence, last_sequence);
            last_sequence = sample.sequence;
        }
        EXPECT_TRUE(server.peerIsAlive());
        device.kill();
        EXPECT_FALSE(server.peerIsAlive());
        server.readSample(sample);
        last_sequence = std::max(last_sequence, sample.sequence);
        EXPECT_FALSE(server.waitForSample(monotonicNowNs() + kNsPerMillisecond));
    }
}

TEST(DeviceLinkProcesses, memoryOfKilledProcessesIsTakenOver) {
    const TestLinkName name;
    {
        Child device([&] { return publishForever(name); });
        DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
        ASSERT_TRUE(server.waitForSample(farAwayNs()));
    }
    {
        Child device([&] { return publishForever(name); });
        while (!name.exists()) usleep(100);
        device.kill();
    }
    ASSERT_TRUE(name.exists());  // a killed process cleans nothing up
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
    EXPECT_FALSE(daemon.peerIsAlive());
    EXPECT_EQ(daemon.writeSample(restingSample()), 1u);
}

}  // namespace
}  // namespace bonemill
