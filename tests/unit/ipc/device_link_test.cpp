#include "common/ipc/device_link.h"

#include <gtest/gtest.h>

#include <thread>

#include "common/ipc/link_layout.h"
#include "common/rt/clock.h"
#include "common/user_error.h"
#include "tests/unit/ipc/link_test_tools.h"

namespace bonemill {
namespace {

DeviceSample sampleOf(double number) {
    DeviceSample sample{};
    sample.stamp_ns = monotonicNowNs();
    for (double& p : sample.p_DT) p = number;
    for (double& q : sample.q_DT) q = number;
    return sample;
}

std::string errorOf(const TestLinkName& name, LinkSide side) {
    try {
        DeviceLink::create(name.session(), side, 1);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(DeviceLink, carriesBothDirections) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
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
    const TestLinkName name;
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    for (int i = 1; i <= 5; ++i) daemon.writeSample(sampleOf(i));
    DeviceSample sample{};
    ASSERT_TRUE(server.readSample(sample));
    EXPECT_EQ(sample.sequence, 5u);
    EXPECT_EQ(sample.p_DT[0], 5.0);
}

TEST(DeviceLink, waitEndsAtTheDeadlineOrWithANewSample) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
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
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
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

TEST(DeviceLink, knowsItsPeer) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    EXPECT_FALSE(server.peerIsAlive());
    EXPECT_EQ(server.peerPid(), 0);
    EXPECT_EQ(server.peerHeartbeatNs(), 0);
    {
        DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
        EXPECT_TRUE(server.peerIsAlive());
        EXPECT_TRUE(daemon.peerIsAlive());
        EXPECT_EQ(server.peerPid(), getpid());
        daemon.beat(12345);
        EXPECT_EQ(server.peerHeartbeatNs(), 12345);
    }
    EXPECT_FALSE(server.peerIsAlive());
    EXPECT_EQ(server.peerPid(), 0);
}

TEST(DeviceLink, isRemovedByTheLastToLeave) {
    const TestLinkName name;
    {
        DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
        { DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1); }
        EXPECT_TRUE(name.exists());
    }
    EXPECT_FALSE(name.exists());
}

TEST(DeviceLink, aRestartedSideCountsOn) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    for (int start = 0; start < 3; ++start) {
        DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
        EXPECT_EQ(daemon.writeSample(sampleOf(1)), uint64_t(start + 1));
    }
}

TEST(DeviceLink, takenSideIsRefused) {
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    EXPECT_NE(errorOf(name, LinkSide::kServer).find("another haptic_server"), std::string::npos);
    EXPECT_TRUE(name.exists());
}

TEST(DeviceLink, memoryOfTheDeadIsTakenOverEmpty) {
    const TestLinkName name;
    RawMemory dead(name);  // left behind by another release
    dead.write(kLinkMagic, 0);
    dead.write(uint32_t(kLinkLayoutVersion + 1), offsetof(LinkMemory, layout_version));
    dead.write(uint32_t(64), offsetof(LinkMemory, size));
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceSample sample{};
    EXPECT_FALSE(server.readSample(sample));
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
    daemon.writeSample(sampleOf(1));
    EXPECT_TRUE(server.readSample(sample));
}

TEST(DeviceLink, foreignMemoryIsRefusedAndLeftAlone) {
    const TestLinkName name;
    RawMemory foreign(name);
    const char text[] = "somebody else's data, long enough for a header";
    foreign.write(text, 0);
    EXPECT_NE(errorOf(name, LinkSide::kDaemon).find("not a bonemill device link"), std::string::npos);
    char kept[sizeof(text)] = {};
    const int file = shm_open(name.str().c_str(), O_RDONLY, 0);
    ASSERT_EQ(pread(file, kept, sizeof(kept), 0), ssize_t(sizeof(kept)));
    close(file);
    EXPECT_STREQ(kept, text);
}

TEST(DeviceLink, aLivingPeerOfAnotherVersionIsNamed) {
    const TestLinkName name;
    RawMemory peer(name);
    peer.hold(kLockServer);
    peer.write(kLinkMagic, 0);
    peer.write(uint32_t(kLinkLayoutVersion + 1), offsetof(LinkMemory, layout_version));
    peer.write(uint32_t(sizeof(LinkMemory)), offsetof(LinkMemory, size));
    const std::string error = errorOf(name, LinkSide::kDaemon);
    EXPECT_NE(error.find("layout version 2, this device_daemon needs 1"), std::string::npos) << error;
    EXPECT_NE(error.find("haptic_server of the same release"), std::string::npos) << error;
}

TEST(DeviceLink, aLivingPeerWithAnotherSizeOrMagicIsRefused) {
    const TestLinkName name;
    RawMemory peer(name);
    peer.hold(kLockDaemon);
    peer.write(kLinkMagic, 0);
    peer.write(kLinkLayoutVersion, offsetof(LinkMemory, layout_version));
    peer.write(uint32_t(sizeof(LinkMemory) + 8), offsetof(LinkMemory, size));
    EXPECT_NE(errorOf(name, LinkSide::kServer).find("wrong size"), std::string::npos);
    peer.write(uint32_t(sizeof(LinkMemory)), offsetof(LinkMemory, size));  // says so, but the file is shorter
    EXPECT_NE(errorOf(name, LinkSide::kServer).find("wrong size"), std::string::npos);
    peer.write(~kLinkMagic, 0);
    EXPECT_NE(errorOf(name, LinkSide::kServer).find("wrong magic"), std::string::npos);
}

TEST(DeviceLink, impossibleNameIsAUserError) {}

}  // namespace
}  // namespace bonemill
