// What two sides say to each other.
#include "common/ipc/device_link.h"

#include <gtest/gtest.h>

#include <thread>

#include "common/rt/clock.h"
#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

DeviceSample sampleOf(double number) {
    DeviceSample sample{};
    sample.stamp_ns = monotonicNowNs();
    for (double& p : sample.p_DT) p = number;
    for (double& q : sample.q_DT) q = number;
    return sample;
}

TEST(DeviceLink, carriesBothDirections) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceSample sample{};
    WrenchCommand command{};
    EXPECT_FALSE(server.readSample(sample));
    EXPECT_FALSE(daemon.readCommand(command));

    EXPECT_EQ(daemon.writeSample(sampleOf(0.25)), 1u);
    ASSERT_TRUE(server.readSample(sample));
    EXPECT_EQ(sample.sequence, 1u);
    EXPECT_EQ(sample.p_DT[2], 0.25);
    EXPECT_EQ(sample.q_DT[3], 0.25);

    WrenchCommand answer{};
    answer.stamp_ns = monotonicNowNs();
    answer.t_hand_D[1] = -0.5;
    answer.answers_sequence = sample.sequence;
    EXPECT_EQ(server.writeCommand(answer), 1u);
    ASSERT_TRUE(daemon.readCommand(command));
    EXPECT_EQ(command.t_hand_D[1], -0.5);
    EXPECT_EQ(command.answers_sequence, 1u);
}

TEST(DeviceLink, newestSampleReplacesTheOneBefore) {
    const TestSession session;
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceLink server = session.open(LinkSide::kServer);
    for (int i = 1; i <= 5; ++i) daemon.writeSample(sampleOf(i));
    DeviceSample sample{};
    ASSERT_TRUE(server.readSample(sample));
    EXPECT_EQ(sample.sequence, 5u);
    EXPECT_EQ(sample.p_DT[0], 5.0);
}

TEST(DeviceLink, waitEndsAtTheDeadlineOrWithANewSample) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    EXPECT_FALSE(server.waitForSample(0));
    const int64_t deadline_ns = monotonicNowNs() + 5 * kNsPerMillisecond;
    EXPECT_FALSE(server.waitForSample(deadline_ns));
    EXPECT_GE(monotonicNowNs(), deadline_ns);

    daemon.writeSample(sampleOf(1));
    EXPECT_TRUE(server.waitForSample(0));
    DeviceSample sample{};
    ASSERT_TRUE(server.readSample(sample));
    EXPECT_FALSE(server.waitForSample(0));  // this one is known
    daemon.writeSample(sampleOf(2));
    EXPECT_TRUE(server.waitForSample(0));
}

TEST(DeviceLink, writingWakesTheSleeper) {
    constexpr int kRounds = 2000;
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    const int64_t far_ns =
        monotonicNowNs() + 250 * kNsPerSecond;  // a lost wake hangs the test into its timeout
    std::thread device([&] {
        for (int i = 0; i < kRounds; ++i) {
            const uint64_t sequence = daemon.writeSample(sampleOf(i));
            WrenchCommand command{};
            do {
                ASSERT_TRUE(daemon.waitForCommand(far_ns));
                ASSERT_TRUE(daemon.readCommand(command));
            } while (command.answers_sequence < sequence);
        }
    });
    uint64_t answered = 0;
    while (answered < kRounds) {
        DeviceSample sample{};
        if (!server.waitForSample(far_ns) || !server.readSample(sample)) break;
        WrenchCommand command{};
        command.answers_sequence = answered = sample.sequence;
        server.writeCommand(command);
    }
    device.join();
    EXPECT_EQ(answered, uint64_t(kRounds));
}

TEST(DeviceLink, capabilitiesAreReadOnceEach) {
    const TestSession session;
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceCapabilities read{};
    EXPECT_FALSE(server.readCapabilities(read));
    for (const double force : {10.0, 20.0}) {
        DeviceCapabilities written{};
        written.max_force = force;
        daemon.writeCapabilities(written);
        ASSERT_TRUE(server.readCapabilities(read));
        EXPECT_EQ(read.max_force, force);
        EXPECT_FALSE(server.readCapabilities(read));
    }
    server.announceScene("/scenes/tooth.textproto", 7);
    EXPECT_TRUE(server.readCapabilities(read)) << "the next scene knows no device yet";
    EXPECT_FALSE(server.readCapabilities(read));
}

TEST(DeviceLink, knowsItsPeer) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    EXPECT_FALSE(server.peerIsAlive());
    EXPECT_EQ(server.peerHeartbeatNs(), 0);
    {
        DeviceLink daemon = session.open(LinkSide::kDaemon);
        EXPECT_TRUE(server.peerIsAlive());
        EXPECT_TRUE(daemon.peerIsAlive());
        daemon.beat(12345);
        EXPECT_EQ(server.peerHeartbeatNs(), 12345);
    }
    EXPECT_FALSE(server.peerIsAlive());
}

}  // namespace
}  // namespace bonemill
