// A period of the device loop, emulated device included, allocates nothing and takes no lock.
#include <gtest/gtest.h>

#include <limits>

#include "device_daemon/driver/ares_emulator.h"
#include "device_daemon/loop/device_loop.h"
#include "tests/support/rt_guard/rt_probe.h"

namespace bonemill {
namespace {

TEST(DeviceLoopIsRtSafe, WithAHandThatMovesAndCommandsOfEveryKind) {
    const OperatorPath path(
        {{0, Pose{}, 0}, {0.2, {{0.01, 0, 0.01}, expRotation({0.2, 0.1, 0})}, 1}, {0.4, Pose{}, 2}}, 1e-4);
    AresEmulator emulator(AresKinematics{}, {}, {}, path);
    DeviceLoop loop(AresKinematics{}, emulator, {}, path.at(0).X_DT);
    emulator.startScenario();

    RtProbe probe;
    for (int i = 0; i < 600; ++i) {
        const int64_t now_ns = 1'000'000LL * (1000 + i);
        DeviceSample sample;
        loop.read(1e-3, sample);
        WrenchCommand command{};
        command.stamp_ns = now_ns;
        command.f_hand_D[2] = i < 100 ? 3 : 3000;
        if (i > 300) command.f_hand_D[0] = std::numeric_limits<double>::quiet_NaN();
        if (i == 500) loop.release();
        loop.write(i % 7 == 0 ? nullptr : &command, now_ns);
    }
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    EXPECT_TRUE(loop.isReleased());
}

}  // namespace
}  // namespace bonemill
