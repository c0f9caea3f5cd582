// Bone that is put back around a burr at work is not cut by a pedal that was down before.
#include <gtest/gtest.h>

#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

using test::SwitchingBench;
using test::ToolBench;

constexpr int kTicks = 300;

// The burr mills its pit; then the bone is put back around it, the pedal still down.
class PutBack : public ::testing::Test {
  protected:
    PutBack() {
        bench_.run(test::straightPath(above_, bottom_.position, 600, kButtonRemove));
        EXPECT_GT(bench_.history.missingVoxels(), 100);
        bench_.history.restore();
        stay(bottom_, kTicks, kButtonRemove);
        EXPECT_EQ(bench_.history.missingVoxels(), 0) << "a hole where the burr was";
        EXPECT_TRUE(last_.waits_for_release);
    }
    void stay(const Pose& pose, int ticks, uint32_t buttons) {
        go(test::straightPath(pose, pose.position, ticks, buttons));
    }
    void go(const std::vector<DeviceInput>& inputs) {
        for (const TickRecord& record : bench_.run(inputs)) {
            const double step = (Eigen::Map<const Eigen::Vector3d>(record.f_hand_W) -
                                 Eigen::Map<const Eigen::Vector3d>(last_.f_hand_W))
                                    .norm();
            EXPECT_LE(step, 1.001 * HandLimits::kForceRate * 1e-3);
            last_ = record;
        }
    }

    Pose above_ = SwitchingBench::at(test::kBenchTop + 1.2e-3);
    Pose high_ = SwitchingBench::at(test::kBenchTop + 2.5e-3);
    Pose bottom_ = SwitchingBench::at(test::kBenchTop - 0.2e-3);
    ToolBench bench_{1};
    TickRecord last_{};
};

TEST_F(PutBack, IsMilledAgainWhenThePedalWasReleasedOnce) {
    stay(bottom_, 1, 0);
    EXPECT_FALSE(last_.waits_for_release);
    stay(bottom_, kTicks, kButtonRemove);
    EXPECT_GT(bench_.history.missingVoxels(), 100);
}

TEST_F(PutBack, IsMilledAgainByABurrThatHasLeftIt) {
    go(test::straightPath(bottom_, high_.position, kTicks, kButtonRemove));
    EXPECT_FALSE(last_.waits_for_release);
    EXPECT_EQ(bench_.history.missingVoxels(), 0);
    go(test::straightPath(high_, bottom_.position, kTicks, kButtonRemove));
    EXPECT_GT(bench_.history.missingVoxels(), 100);
}

TEST_F(PutBack, KeepsWaitingWhileTheOtherButtonIsDownAndForASilentDevice) {
    stay(bottom_, kTicks, kButtonAdd);
    EXPECT_EQ(bench_.history.missingVoxels(), 0);
    auto silent = test::straightPath(bottom_, bottom_.position, 5, 0);
    for (DeviceInput& input : silent) input.is_stale = true;
    go(silent);
    EXPECT_TRUE(last_.waits_for_release) << "nobody knows whether it was released";
}

TEST(PutBackAside, ABurrInTheAirGoesOnIntoTheBone) {
    ToolBench bench(1);
    const Pose above = SwitchingBench::at(test::kBenchTop + 2.5e-3);
    bench.history.restore();
    bench.run(test::straightPath(above, above.position, 100, kButtonRemove));
    bench.run(test::straightPath(above, SwitchingBench::at(test::kBenchTop).position, 600, kButtonRemove));
    EXPECT_GT(bench.history.missingVoxels(), 100);
}

}  // namespace
}  // namespace bonemill
