// The motion made of wishes in steps is smooth, within its bounds and does not overshoot.
#include <gtest/gtest.h>

#include <cmath>

#include "device_daemon/hands/virtual_handle/virtual_handle.h"

namespace bonemill {
namespace {

constexpr double kStep = 1e-4;  // s

Pose at(double x, double turn = 0) {
    return {{x, 0, 0}, expRotation({0, 0, turn})};
}

TEST(MotionFilter, ArrivesWithoutOvershootWithinItsBounds) {
    for (const double way : {1e-4, 0.01, 0.2}) {
        MotionFilter motion{Pose{}};
        motion.want(at(way, 10 * way));
        Eigen::Vector3d v_before = motion.v_DT(), w_before = motion.w_DT();
        for (int i = 0; i < 20000; ++i) {
            motion.advance(kStep);
            EXPECT_LT(motion.pose().position.x(), way * (1 + 1e-6)) << way;
            EXPECT_LT(logRotation(motion.pose().rotation).z(), 10 * way * (1 + 1e-6)) << way;
            EXPECT_LE(motion.v_DT().norm(), MotionFilter::kMaxSpeed * (1 + 1e-9));
            EXPECT_LE(motion.w_DT().norm(), MotionFilter::kMaxSpin * (1 + 1e-9));
            EXPECT_LE((motion.v_DT() - v_before).norm(), kStep * MotionFilter::kMaxAcceleration * (1 + 1e-9));
            EXPECT_LE((motion.w_DT() - w_before).norm(), kStep * MotionFilter::kMaxSpinChange * (1 + 1e-9));
            v_before = motion.v_DT();
            w_before = motion.w_DT();
        }
        EXPECT_NEAR(motion.pose().position.x(), way, 1e-7);
        EXPECT_NEAR(logRotation(motion.pose().rotation).z(), 10 * way, 1e-6);
    }
}

TEST(MotionFilter, TrailsASteadyWishByItsTime) {
    constexpr double kSpeed = 0.05;  // m/s
    MotionFilter motion{Pose{}};
    double t = 0;
    for (int i = 0; i < 10000; ++i) {
        motion.want(at(kSpeed * (t += kStep)));
        motion.advance(kStep);
    }
    const double trail = kSpeed * (2 / MotionFilter::kBandwidth + MotionFilter::kShortestInterval);
    EXPECT_NEAR(kSpeed * t - motion.pose().position.x(), trail, 0.02 * trail);
    EXPECT_NEAR(motion.v_DT().x(), kSpeed, 1e-6);
}

TEST(MotionFilter, TurnsTheShortWay) {
    MotionFilter motion{at(0, 3)};
    motion.want(at(0, -3));
    for (int i = 0; i < 100; ++i) motion.advance(kStep);
    EXPECT_GT(motion.w_DT().z(), 0);
}

}  // namespace
}  // namespace bonemill
