#include <gtest/gtest.h>

#include <cmath>

#include "device_daemon/ares/driver/jump_check.h"
#include "device_daemon/ares/driver/udp_pose_device.h"

namespace bonemill {
namespace {

constexpr int64_t kGuardStepNs = 1'000'000;

Pose at(double x, double turn = 0) {
    return {{x, 0, 0}, expRotation({0, 0, turn})};
}

TEST(JumpCheck, AllowsTheLargestSpeedAndTheSlackAndNoMore) {
    constexpr JumpCheck kCheck(3, 20e-6);
    EXPECT_FALSE(kCheck.isJump(3e-3 + 15e-6, 1e-3));
    EXPECT_TRUE(kCheck.isJump(3e-3 + 25e-6, 1e-3));
    EXPECT_TRUE(kCheck.isJump(std::nan(""), 1e-3));
}

TEST(JumpCheck, ASilentTimeCountsAsTime) {
    constexpr JumpCheck kCheck(3, 20e-6);
    EXPECT_FALSE(kCheck.isJump(10e-3, 4e-3));
    EXPECT_TRUE(kCheck.isJump(10e-3, -1));
}

TEST(PoseGuard, LetsAFastHandThrough) {
    PoseGuard guard;
    // Half a metre to and fro with 4 m/s, and turns of 40 rad/s, with a stamp that is off now and then.
    for (int i = 0; i < 5000; ++i) {
        const double t = 1e-3 * i;
        const int64_t stamp_ns = i * kGuardStepNs + (i % 7 == 0 ? 300'000 : 0);
        ASSERT_TRUE(guard.take(at(0.5 * std::sin(8 * t), 3 * std::sin(13 * t)), stamp_ns, true)) << i;
    }
    EXPECT_EQ(guard.cause(), StopCause::kNone);
}

TEST(PoseGuard, BelievesNothingAfterAJumpUntilAReset) {
    for (const Pose& far : {at(0.02), at(0, 0.4)}) {
        PoseGuard guard;
        ASSERT_TRUE(guard.take(at(0), 0, true));
        EXPECT_FALSE(guard.take(far, kGuardStepNs, true));
        EXPECT_EQ(guard.cause(), StopCause::kPoseJump);
        EXPECT_FALSE(guard.take(at(0), 1000 * kGuardStepNs, true)) << "back where it was proves nothing";
        guard.restart();
        EXPECT_FALSE(guard.take(at(0), 0, true)) << "nor does another session";
        EXPECT_EQ(guard.cause(), StopCause::kPoseJump);
        guard.reset();
        EXPECT_TRUE(guard.take(far, 1001 * kGuardStepNs, true));
        EXPECT_EQ(guard.cause(), StopCause::kNone);
    }
}

TEST(PoseGuard, TimeIsThatOfTheBridge) {
    PoseGuard guard;
    ASSERT_TRUE(guard.take(at(0), 0, true));
    EXPECT_TRUE(guard.take(at(0.05), 20 * kGuardStepNs, true)) << "packets in between were lost";
    EXPECT_FALSE(guard.take(at(0.06), 20 * kGuardStepNs, true)) << "no time has passed";
    guard.reset();
    ASSERT_TRUE(guard.take(at(0), INT64_MAX, true));
    EXPECT_TRUE(guard.take(at(0.001), INT64_MIN, true)) << "the clock wraps";
    guard.reset();
    ASSERT_TRUE(guard.take(at(0), 0, true));
    guard.restart();
    EXPECT_TRUE(guard.take(at(0.1), -5, true)) << "another clock and another place";
}

TEST(PoseGuard, AnArmMayJumpWhileItFindsItsZero) {
    PoseGuard guard;
    ASSERT_TRUE(guard.take(at(0), 0, true));
    EXPECT_TRUE(guard.take(at(0.3), kGuardStepNs, false));
    EXPECT_TRUE(guard.take(at(0.1), 2 * kGuardStepNs, true));
    EXPECT_FALSE(guard.take(at(0.3), 3 * kGuardStepNs, true));
    EXPECT_TRUE(guard.take(at(0.1), 4 * kGuardStepNs, false)) << "it calibrates anew";
    EXPECT_TRUE(guard.take(at(0.1), 5 * kGuardStepNs, true));
}

TEST(PoseGuard, WhatIsNoPoseIsRefusedAsLongAsItIsNone) {
    PoseGuard guard;
    ASSERT_TRUE(guard.take(at(0), 0, true));
    Pose longer = at(0);
    longer.rotation.w() = 1.01;
    EXPECT_FALSE(guard.take(longer, kGuardStepNs, true));
    EXPECT_EQ(guard.cause(), StopCause::kImplausiblePose);
    EXPECT_FALSE(guard.take(at(11), 2 * kGuardStepNs, true));
    EXPECT_TRUE(guard.take(at(0.001), 3 * kGuardStepNs, true));
    EXPECT_FALSE(guard.take(longer, 4 * kGuardStepNs, false));
    EXPECT_EQ(guard.cause(), StopCause::kNone) << "before calibration that is no fault";
}

}  // namespace
}  // namespace bonemill
