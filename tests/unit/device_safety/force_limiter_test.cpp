#include "device_daemon/safety/force_limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr int64_t kPeriodNs = kNsPerMillisecond;

class ForceLimiterTest : public testing::Test {
  protected:
    ForceLimiterTest() {
        EXPECT_TRUE(AresKinematics{}.inverseJacobian(Pose{}, J_inv));
        for (int n = 0; n < 500; ++n) feel({});  // the server answers: the ramp is up
    }

    // In this period the server answers with this wrench.
    Vector6d feel(const Wrench& wrench, double dt = kPeriod) {
        now_ns += kPeriodNs;
        limiter.take(wrench, now_ns);
        return limiter.forces(&J_inv, now_ns, dt);
    }
    // In this period the server is silent.
    Vector6d wait() {
        now_ns += kPeriodNs;
        return limiter.forces(&J_inv, now_ns, kPeriod);
    }
    // It is long enough to reach any target within the rate.
    Vector6d settle(const Wrench& wrench) {
        Vector6d forces;
        for (int i = 0; i < 100; ++i) forces = feel(wrench);
        return forces;
    }

    int64_t now_ns = kNsPerSecond;
    Matrix6d J_inv;
    ForceLimits limits;
    ForceLimiter limiter{limits};
};

TEST_F(ForceLimiterTest, PassesASmallWrenchUnchanged) {
    const Wrench wrench{{1, -2, 3}, {0.01, 0.02, -0.03}};
    const Wrench felt = wrenchOf(J_inv, feel(wrench));
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
        const Vector6d forces = feel(wrench);
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
    const Matrix6d singular = Matrix6d::Zero();
    Vector6d forces;
    for (int n = 0; n < 100; ++n) {
        now_ns += kPeriodNs;
        limiter.take({{0, 0, 20}, {0, 0, 0}}, now_ns);
        forces = limiter.forces(n % 2 ? &singular : nullptr, now_ns, kPeriod);
    }
    EXPECT_EQ(forces, Vector6d::Zero());
    EXPECT_TRUE(limiter.events() & kForceNotFinite);
}

TEST_F(ForceLimiterTest, HoldsStillWhenNoTimePasses) {
    const Vector6d before = settle({{0, 0, 20}, {0, 0, 0}});
    EXPECT_EQ(feel({{0, 0, -20}, {0, 0, 0}}, 0.0), before);
    EXPECT_EQ(feel({{0, 0, -20}, {0, 0, 0}}, -1.0), before);
}

// The order of the limits matters: silence fades what is sent, not what was wanted, so that a demand of many
// times the clamp is half as strong in the middle of the ramp, and turns nowhere.
TEST_F(ForceLimiterTest, ADemandBeyondTheClampFadesAsAnyOther) {
    const StaleRampConfig ramp;
    const Vector6d pressing = settle({{0, 0, 1000}, {0, 0, 0}});
    EXPECT_NEAR(pressing.cwiseAbs().maxCoeff(), limits.max_actuator_force, 1e-9);
    const int64_t silent_since_ns = now_ns + ramp.stale_after_ns;
    Vector6d before = pressing;
    while (now_ns < silent_since_ns + ramp.ramp_down_ns) {
        const Vector6d forces = wait();
        const double share =
            std::clamp(1 - double(now_ns - silent_since_ns) / double(ramp.ramp_down_ns), 0.0, 1.0);
        EXPECT_LT((forces - share * pressing).norm(), 1e-9);
        EXPECT_LE((forces - before).cwiseAbs().maxCoeff(),
                  limits.max_actuator_force * kPeriodNs / double(ramp.ramp_down_ns) * (1 + 1e-9));
        before = forces;
    }
    EXPECT_EQ(before, Vector6d::Zero());
    EXPECT_TRUE(limiter.isStale());
}

TEST_F(ForceLimiterTest, NothingComesAfterTheRampHowSlowTheRateEver) {
    limits.max_actuator_force_rate = 10;
    limiter = ForceLimiter(limits);
    for (int n = 0; n < 500; ++n) feel({{0, 0, 5}, {0, 0, 0}});
    EXPECT_GT(wait().norm(), 1);
    limiter.release();
    for (int n = 0; n < 60; ++n) wait();
    EXPECT_TRUE(limiter.isReleased());
    EXPECT_EQ(feel({{0, 0, 5}, {0, 0, 0}}), Vector6d::Zero());
}

TEST_F(ForceLimiterTest, WhereTheMotorsGiveNothingNothingWasLimited) {
    settle({{0, 0, 1000}, {0, 0, 0}});
    limiter.release();
    while (!limiter.isReleased()) feel({{0, 0, 1000}, {0, 0, 0}});
    for (const double size : {1000.0, -1000.0}) {
        EXPECT_EQ(feel({{0, 0, size}, {0, 0, 0}}), Vector6d::Zero());
        EXPECT_EQ(limiter.events(), kForceNotLimited);
    }
}

TEST_F(ForceLimiterTest, NoDemandAndNoOrderOfDemandsPassesTheClamp) {
    for (const double size : {1e3, -1e3, 1e9, -1e300, 30.0}) {
        for (int n = 0; n < 8; ++n) {
            const Vector6d forces = feel({{size, -size, 0.3 * size}, {0.1 * size, 0, size}});
            EXPECT_LE(forces.cwiseAbs().maxCoeff(), limits.max_actuator_force * (1 + 1e-12));
        }
    }
}

TEST_F(ForceLimiterTest, WithoutACommandThereIsNoForce) {
    limiter = ForceLimiter(limits);
    EXPECT_EQ(wait(), Vector6d::Zero());
    EXPECT_TRUE(limiter.isStale());
}

}  // namespace
}  // namespace bonemill
