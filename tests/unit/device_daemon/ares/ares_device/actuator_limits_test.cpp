#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "common/ares_kinematics/ares_kinematics.h"
#include "device_daemon/ares/ares_device/ares_device.h"
#include "tests/support/random_direction.h"

namespace bonemill {
namespace {

Vector6d randomForces(std::mt19937& random, double size) {
    Vector6d forces;
    forces << test::randomVector(random), test::randomVector(random);
    return size * forces;
}

TEST(ActuatorLimits, LetsThroughWhatFits) {
    const Vector6d base = Vector6d::Constant(3), wanted = Vector6d::Constant(-20);
    const LimitedForces limited = limitForces(base, wanted, 50);
    EXPECT_EQ(limited.forces, base + wanted);
    EXPECT_EQ(limited.wanted_share, 1);
    EXPECT_EQ(limited.base_share, 1);
}

TEST(ActuatorLimits, ScalesTheWantedForcesByOneFactorAndNeverTheBase) {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Vector6d base = randomForces(random, 8), wanted = randomForces(random, 60);
        if (base.cwiseAbs().maxCoeff() > 50) continue;
        const LimitedForces limited = limitForces(base, wanted, 50);
        EXPECT_LE(limited.forces.cwiseAbs().maxCoeff(), 50);
        EXPECT_EQ(limited.base_share, 1);
        EXPECT_LT((limited.forces - base - limited.wanted_share * wanted).norm(), 1e-12);
        // It gives all that it can: the whole, or one motor at its limit.
        const bool is_at_limit = std::abs(limited.forces.cwiseAbs().maxCoeff() - 50) < 1e-9;
        EXPECT_TRUE(limited.wanted_share == 1 || is_at_limit);
    }
}

TEST(ActuatorLimits, ScalesABaseThatIsTooMuchAndLeavesNothingForTheRest) {
    const Vector6d base = 30 * Vector6d(1, 2, 3, 1, 2, 3), wanted = Vector6d::Constant(10);
    const LimitedForces limited = limitForces(base, wanted, 50);
    EXPECT_NEAR(limited.base_share, 50.0 / 90, 1e-12);
    EXPECT_EQ(limited.wanted_share, 0);
    EXPECT_LT((limited.forces - base * 50 / 90).norm(), 1e-12);
}

TEST(ActuatorLimits, GivesNoForceForWhatIsNotANumber) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Vector6d broken = Vector6d::Ones();
        broken[4] = bad;
        for (const LimitedForces& limited :
             {limitForces(broken, Vector6d::Ones(), 50), limitForces(Vector6d::Ones(), broken, 50)}) {
            EXPECT_EQ(limited.forces, Vector6d::Zero());
            EXPECT_FALSE(limited.is_finite);
        }
    }
}

TEST(ActuatorLimits, TheMotorsGiveThePowerOfTheScaledWrench) {
    const AresKinematics kinematics;
    std::mt19937 random(2);
    for (int i = 0; i < 300; ++i) {
        Matrix6d J_inv;
        ASSERT_TRUE(kinematics.inverseJacobian(
            {0.01 * test::randomVector(random), expRotation(0.5 * test::randomDirection(random))}, J_inv));
        const Wrench wrench{80 * test::randomDirection(random), 2 * test::randomDirection(random)};
        const LimitedForces limited = limitForces(Vector6d::Zero(), actuatorForces(J_inv, wrench), 50);
        const Vector6d twist = randomForces(random, 1);
        const double felt =
            limited.wanted_share * (wrench.force.dot(twist.head<3>()) + wrench.torque.dot(twist.tail<3>()));
        EXPECT_NEAR(limited.forces.dot(J_inv * twist), felt, 1e-8);
    }
}

}  // namespace
}  // namespace bonemill
