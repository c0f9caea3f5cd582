// A period of the ARES device, with its emulator, allocates nothing and takes no lock: in normal use, in soft
// walls, and after every fault.
#include <gtest/gtest.h>

#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/device_daemon/ares/ares_device/ares_bench.h"

namespace bonemill {
namespace {

TEST(AresDeviceIsRtSafe, InUseInWallsAndAfterFaults) {
    AresDeviceConfig config;
    config.weight.mass = 0.5;
    config.guard.home = HomePlace{};
    const OperatorPath path({{0, {}, 0}, {0.3, {{0, 0, 0.09}, expRotation({0, 0, 1.0})}, 0}}, 5e-5);
    test::AresBench bench(path, config);

    RtProbe probe;
    const DeviceCapabilities capabilities = bench.device.capabilities();
    for (int i = 0; i < 500; ++i) bench.step(test::engaged({0, 0, i < 100 ? 3.0 : 300.0}));
    for (int joint = 0; joint < 6; ++joint) {
        bench.joints.offset[joint] = 0.01;
        bench.step(test::engaged());
        bench.joints.bad_joint = joint;
        bench.step(test::engaged({std::nan(""), 0, 0}));
        bench.joints.bad_joint = -1;
        bench.joints.is_silent = joint % 2;
        DeviceOrder reset = test::engaged();
        reset.reset = true;
        bench.step(reset);
    }
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    EXPECT_GT(capabilities.max_force, 0);
}

}  // namespace
}  // namespace bonemill
