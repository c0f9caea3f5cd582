// Tries the link between real processes: start order, death, standstill and return.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/rt/clock.h"
#include "tests/unit/common/ipc/child.h"
#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

int64_t farAwayNs() {
    return monotonicNowNs() + 250 * kNsPerSecond;
}

DeviceSample restingSample() {
    DeviceSample sample{};
    sample.stamp_ns = monotonicNowNs();
    sample.q_DT[0] = 1.0;
    return sample;
}

int publishForever(const TestSession& session) {
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    for (;;) {
        daemon.writeSample(restingSample());
        usleep(200);
    }
}

TEST(DeviceLinkProcesses, everySampleIsAnsweredAcrossProcesses) {
    constexpr uint64_t kSamples = 2000;
    const TestSession session;
    Child device([&] {
        DeviceLink daemon = session.open(LinkSide::kDaemon);
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
    DeviceLink server = session.open(LinkSide::kServer);
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
    const TestSession session;
    for (int round = 0; round < 100; ++round) {
        Child device([&] {
            DeviceLink daemon = session.open(LinkSide::kDaemon);
            WrenchCommand command{};
            daemon.writeSample(restingSample());
            return daemon.waitForCommand(farAwayNs()) && daemon.readCommand(command) ? kSuccess : 1;
        });
        DeviceLink server = session.open(LinkSide::kServer);
        DeviceSample sample{};
        ASSERT_TRUE(server.waitForSample(farAwayNs()) && server.readSample(sample));
        server.writeCommand({});
        ASSERT_EQ(device.exitCode(), kSuccess) << round;
    }
}

TEST(DeviceLinkProcesses, aKilledDaemonIsNoticedAndMayReturn) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    uint64_t last_sequence = 0;
    for (int life = 0; life < 10; ++life) {
        Child device([&] { return publishForever(session); });
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
    const TestSession session;
    {
        Child device([&] { return publishForever(session); });
        DeviceLink server = session.open(LinkSide::kServer);
        ASSERT_TRUE(server.waitForSample(farAwayNs()));
    }
    {
        Child device([&] { return publishForever(session); });
        while (!session.hasMemory()) usleep(100);
        device.kill();
    }
    ASSERT_TRUE(session.hasMemory());  // a killed process cleans nothing up
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    EXPECT_FALSE(daemon.peerIsAlive());
    EXPECT_EQ(daemon.writeSample(restingSample()), 1u);
}

TEST(DeviceLinkProcesses, aKilledServerMayReturnAndFindsWhatTheDaemonSays) {
    const TestSession session;
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceCapabilities capabilities{};
    capabilities.max_force = 12;
    daemon.writeCapabilities(capabilities);
    daemon.writeSample(restingSample());
    uint64_t last_sequence = 0;
    for (int life = 0; life < 10; ++life) {
        Child server([&] {
            DeviceLink link = session.open(LinkSide::kServer);
            DeviceSample sample{};
            DeviceCapabilities found{};
            if (!link.readSample(sample) || !link.readCapabilities(found) || found.max_force != 12) return 1;
            for (;;) link.writeCommand({});
        });
        WrenchCommand command{};
        while (command.sequence <= last_sequence) {
            ASSERT_TRUE(daemon.waitForCommand(farAwayNs()));
            daemon.readCommand(command);
        }
        EXPECT_TRUE(daemon.peerIsAlive());
        server.kill();
        EXPECT_FALSE(daemon.peerIsAlive());
        daemon.readCommand(command);
        last_sequence = command.sequence;
    }
}

TEST(DeviceLinkProcesses, aStoppedDaemonLivesAndGoesOn) {
    const TestSession session;
    Child device([&] { return publishForever(session); });
    DeviceSample sample{};
    {
        DeviceLink server = session.open(LinkSide::kServer);
        ASSERT_TRUE(server.waitForSample(farAwayNs()));
        device.stop();
        EXPECT_TRUE(server.peerIsAlive());
        server.readSample(sample);
        EXPECT_FALSE(server.waitForSample(monotonicNowNs() + kNsPerMillisecond));
    }
    EXPECT_TRUE(says(session.refusalOf(LinkSide::kDaemon), "another device_daemon"));
    DeviceLink server = session.open(LinkSide::kServer);  // needs nothing of the one that stands still
    const uint64_t before = sample.sequence;
    device.goOn();
    while (sample.sequence <= before + 1) {
        ASSERT_TRUE(server.waitForSample(farAwayNs()));
        server.readSample(sample);
    }
}

TEST(DeviceLinkProcesses, aStoppedServerHoldsNoDaemonUp) {
    const TestSession session;
    Child server([&] {
        DeviceLink link = session.open(LinkSide::kServer);
        for (;;) {
            if (link.waitForSample(farAwayNs())) link.writeCommand({});
            DeviceSample sample;
            link.readSample(sample);
        }
        return kSuccess;
    });
    uint64_t last_sequence = 0;
    for (int life = 0; life < 3; ++life) {
        DeviceLink daemon = session.open(LinkSide::kDaemon);
        WrenchCommand command{};
        while (!daemon.peerIsAlive()) usleep(100);
        while (command.sequence <= last_sequence) {
            daemon.writeSample(restingSample());
            daemon.waitForCommand(monotonicNowNs() + kNsPerMillisecond);
            daemon.readCommand(command);
        }
        server.stop();
        EXPECT_TRUE(daemon.peerIsAlive());
        const uint64_t first = daemon.writeSample(restingSample());
        EXPECT_EQ(daemon.writeSample(restingSample()), first + 1);  // and wakes whoever sleeps, in vain
        daemon.readCommand(command);
        last_sequence = command.sequence;
        server.goOn();
    }
}

TEST(DeviceLinkProcesses, ofTwoOnTheSameSideOneIsRefused) {
    constexpr int kRefused = 7;
    const TestSession session;
    for (int round = 0; round < 100; ++round) {
        Child other([&] {
            try {
                const DeviceLink link = session.open(LinkSide::kServer);
                return pause();
            } catch (const UserError& error) {
                return says(error.what(), "another haptic_server") ? kRefused : 1;
            }
        });
        usleep(10 * round);  // so that either may be the first
        try {
            const DeviceLink link = session.open(LinkSide::kServer);
            ASSERT_EQ(other.exitCode(), kRefused) << round;
        } catch (const UserError& error) {
            ASSERT_TRUE(says(error.what(), "another haptic_server")) << error.what();
        }
    }
}

TEST(DeviceLinkProcesses, bothMayComeAndGoAsTheyLike) {
    constexpr int kStarts = 1000;
    const TestSession session;
    const auto comeAndGo = [&](LinkSide side) {
        for (int start = 0; start < kStarts; ++start) {
            DeviceLink link = session.open(side);
            link.peerIsAlive();
        }
        return kSuccess;
    };
    Child device([&] { return comeAndGo(LinkSide::kDaemon); });
    EXPECT_NO_THROW(comeAndGo(LinkSide::kServer));
    EXPECT_EQ(device.exitCode(), kSuccess);
    EXPECT_FALSE(session.hasMemory() || session.hasSemaphores());
}

}  // namespace
}  // namespace bonemill
