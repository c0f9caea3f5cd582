#include "device_daemon/safety/force_limiter.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;  // s

class ForceLimiterTest : public testing::Test {
  protected:
    ForceLimiterTest() { EXPECT_TRUE(AresKinematics{}.inverseJacobian(Pose{}, J_inv)); }

    // Long enough to reach any target within the rate.
    Vector6d settle(const Wrench& wrench) {
        Vector6d forces;
        for (int i = 0; i < 100; ++i) forces = limiter.limit(wrench, J_inv, kPeriod);
        return forces;
    }

    Matrix6d J_inv;
    ForceLimits limits;
    ForceLimiter limiter{limits};
};

TEST_F(ForceLimiterTest, PassesASmallWrenchUnchanged) {
    const Wrench wrench{{1, -2, 3}, {0.01, 0.02, -0.03}};
    const Wrench felt = wrenchOf(J_inv, limiter.limit(wrench, J_inv, kPeriod));
    EXPECT_EQ(limiter.events(), kForceNotLimited);
    EXPECT_LT((felt.force - wrench.force).norm(), 1e-12);
    EXPECT_LT((felt.torque - wrench.torque).norm(), 1e-12);
}

TEST_F(ForceLimiterTest, ClampsToTheActuatorsAndKeepsTheDirection) {
    const Wrench wrench{{300, 100, -50}, {1, 2, 3}};
    const Vector6d forces = settle(wrench);
    EXPECT_NEAR(forces.cwiseAbs().maxCoeff(), limits.max_actuator_force, 1e-9);
    EXPECT_TRUE(limiter.events() & kForceClamped);
    const Wrench felt = wrenchOf(J_inv, forces);
    const double factor = felt.force.norm() / wrench.force.norm();
    EXPECT_LT(factor, 1);
    EXPECT_LT((felt.force - factor * wrench.force).norm(), 1e-9);
    EXPECT_LT((felt.torque - factor * wrench.torque).norm(), 1e-9);
}

TEST_F(ForceLimiterTest, BoundsTheChangePerPeriod) {
    const double step = limits.max_actuator_force_rate * kPeriod;
    const Wrench up{{0, 0, 200}, Eigen::Vector3d::Zero()};
    Vector6d before = Vector6d::Zero();
    for (const Wrench& wrench : {up, up, up, -up, -up, up}) {
        const Vector6d forces = limiter.limit(wrench, J_inv, kPeriod);
        EXPECT_LE((forces - before).cwiseAbs().maxCoeff(), step * (1 + 1e-12));
        EXPECT_TRUE(limiter.events() & kForceRateLimited);
        before = forces;
    }
}

TEST_F(ForceLimiterTest, FadesOutOnNonFiniteInput) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const Wrench& bad : {Wrench{{nan, 0, 0}, {0, 0, 0}}, Wrench{{0, 0, 0}, {0, infinity, 0}}}) {
        EXPECT_GT(settle({{0, 0, 20}, {0, 0, 0}}).norm(), 1);
        const Vector6d forces = settle(bad);
        EXPECT_TRUE(limiter.events() & kForceNotFinite);
        EXPECT_EQ(forces, Vector6d::Zero());
    }
}

TEST_F(ForceLimiterTest, FadesOutInASingularPose) {
    EXPECT_GT(settle({{0, 0, 20}, {0, 0, 0}}).norm(), 1);
    J_inv.setZero();
    EXPECT_EQ(settle({{0, 0, 20}, {0, 0, 0}}), Vector6d::Zero());
    EXPECT_TRUE(limiter.events() & kForceNotFinite);
}

TEST_F(ForceLimiterTest, HoldsStillWhenNoTimePasses) {
    const Vector6d before = settle({{0, 0, 20}, {0, 0, 0}});
    EXPECT_EQ(limiter.limit({{0, 0, -20}, {0, 0, 0}}, J_inv, 0.0), before);
    EXPECT_EQ(limiter.limit({{0, 0, -20}, {0, 0, 0}}, J_inv, -1.0), before);
}

}  // namespace
}  // namespace bonemill
