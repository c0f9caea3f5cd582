// Random bytes in the shared memory lead to a clear refusal at attach, or to messages that isPlausible can
// judge, never to a crash.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "common/user_error.h"
#include "tests/unit/ipc/link_test_tools.h"

namespace bonemill {
namespace {

std::vector<unsigned char> randomBytes(std::mt19937_64& random, size_t size) {
    std::vector<unsigned char> bytes(size);
    for (unsigned char& byte : bytes) byte = (unsigned char)(random());
    return bytes;
}

bool isUsable(const DeviceSample& sample) {
    for (const double p : sample.p_DT) {
        if (!std::isfinite(p)) return false;
    }
    double squares = 0;
    for (const double q : sample.q_DT) squares += q * q;
    return std::abs(std::sqrt(squares) - 1) < 0.01;
}

TEST(DeviceLinkFuzz, randomMemoryOfNobodyIsRefused) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 500; ++round) {
        const TestLinkName name;
        RawMemory memory(name);
        const auto bytes = randomBytes(random, 1 + random() % (2 * sizeof(LinkMemory)));
        memory.write(bytes.data(), bytes.size(), 0);
        EXPECT_THROW(DeviceLink::create(name.session(), LinkSide::kServer, 1), UserError);
    }
}

TEST(DeviceLinkFuzz, randomMemoryOfALivingPeerIsRefused) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 500; ++round) {
        const TestLinkName name;
        RawMemory memory(name);
        memory.hold(kLockDaemon);
        auto bytes = randomBytes(random, 1 + random() % (2 * sizeof(LinkMemory)));
        // Some get past the first checks.
        if (round % 2 && bytes.size() >= sizeof(kLinkMagic))
            std::memcpy(bytes.data(), &kLinkMagic, sizeof(kLinkMagic));
        memory.write(bytes.data(), bytes.size(), 0);
        EXPECT_THROW(DeviceLink::create(name.session(), LinkSide::kServer, 1), UserError);
    }
}

TEST(DeviceLinkFuzz, garbageBehindAValidHeaderIsReadAndJudged) {
    std::mt19937_64 random(3);
    const TestLinkName name;
    DeviceLink server = DeviceLink::create(name.session(), LinkSide::kServer, 1);
    DeviceLink daemon = DeviceLink::create(name.session(), LinkSide::kDaemon, 1);
    RawMemory memory(name);
    constexpr size_t kBody = offsetof(LinkMemory, server);
    int samples_read = 0;
    for (int round = 0; round < 5000; ++round) {
        const auto bytes = randomBytes(random, sizeof(LinkMemory) - kBody);
        memory.write(bytes.data(), bytes.size(), kBody);
        DeviceSample sample{};
        WrenchCommand command{};
        server.waitForSample(monotonicNowNs());
        if (server.readSample(sample)) {
            ++samples_read;
            if (isPlausible(sample)) {
                EXPECT_TRUE(isUsable(sample));
            }
        }
        if (daemon.readCommand(command) && isPlausible(command)) {
            for (const double f : command.f_hand_D) EXPECT_TRUE(std::isfinite(f));
            for (const double t : command.t_hand_D) EXPECT_TRUE(std::isfinite(t));
        }
        server.peerHeartbeatNs();
        server.peerIsAlive();
        daemon.waitForCommand(0);
    }
    EXPECT_GT(samples_read, 1000);  // the garbage really came through to the judge
    DeviceSample good{};
    good.q_DT[0] = 1.0;
    daemon.writeSample(good);
    DeviceSample sample{};
    ASSERT_TRUE(server.readSample(sample));  // and the link works again with the next honest write
    EXPECT_TRUE(isPlausible(sample));
}

}  // namespace
}  // namespace bonemill
