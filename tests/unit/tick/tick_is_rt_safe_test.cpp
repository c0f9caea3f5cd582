// tick() allocates nothing and takes no lock: counted by replaced heap and lock functions, over everything a
// tick does.
#include <gtest/gtest.h>

#include <limits>

#include "haptic_server/tick/haptic_tick.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

class TickIsRtSafe : public testing::Test {
  protected:
    TickIsRtSafe()
        : bone_(test::bodyVolume(test::cubeGeometry(64, 0.125e-3),
                                 test::halfSpace({0, 0, 5e-3}, Eigen::Vector3d::UnitZ())),
                Eigen::Vector3i::Constant(16), ShellConfig{}),
          tool_(test::sphereToolModel(1e-3, 0.125e-3)),
          reset_(bone_),
          tick_({}, bone_, tool_, &reset_) {}

    // Runs the inputs under the probe; what the test itself keeps is allocated before.
    void expectQuiet(const std::vector<DeviceInput>& inputs) { expectQuiet(tick_, inputs); }
    void expectQuiet(HapticTick& tick, const std::vector<DeviceInput>& inputs) {
        test::ScriptedIo io(inputs);
        RtProbe probe;
        while (tick.tick(io)) {
        }
        probe.stop();
        EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        records_ = io.records;
    }
    size_t removedVoxels() const {
        size_t sum = 0;
        for (const TickRecord& record : records_) sum += record.removed_voxels;
        return sum;
    }
    static Pose at(double z) { return {{4e-3, 4e-3, z}, Eigen::Quaterniond::Identity()}; }

    BoneModel bone_;
    ToolModel tool_;
    VolumeReset reset_;
    HapticTick tick_;
    std::vector<TickRecord> records_;
};

TEST_F(TickIsRtSafe, WhileMillingAndAddingAndResetting) {
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
    EXPECT_GT(removedVoxels(), 1000u);
    expectQuiet(test::straightPath(at(3e-3), {4e-3, 4e-3, 6e-3}, 300, kButtonAdd));
    reset_.request();
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 6.2e-3}, 500, 0));
    EXPECT_FALSE(reset_.isRunning());
}

TEST_F(TickIsRtSafe, AsThesis2012) {
    TickConfig config;
    config.accuracy = presetSettings(Preset::kThesis2012);
    HapticTick tick(config, bone_, tool_, &reset_);
    expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
    EXPECT_GT(removedVoxels(), 1000u);
    expectQuiet(tick, test::straightPath(at(3e-3), {4e-3, 4e-3, 6e-3}, 300, kButtonAdd));
}

TEST_F(TickIsRtSafe, WhileFaultsHappen) {
    auto inputs = test::straightPath(at(6e-3), {4e-3, 4e-3, 5.5e-3}, 100, kButtonRemove);
    inputs[20].X_WT_device.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    inputs[30].X_WT_device.position.x() += 1;
    inputs[40].is_stale = true;
    inputs[50].X_WT_device.rotation.coeffs().setZero();
    expectQuiet(inputs);
    EXPECT_TRUE(tick_.latchedFaults() & kFaultBadDevicePose);
    EXPECT_TRUE(tick_.latchedFaults() & kFaultMotionClamped);
}

}  // namespace
}  // namespace bonemill
