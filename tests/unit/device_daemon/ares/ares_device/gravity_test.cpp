#include <gtest/gtest.h>

#include <random>

#include "device_daemon/ares/ares_device/ares_device.h"
#include "tests/support/random_direction.h"

namespace bonemill {
namespace {

TEST(Gravity, NothingToHoldWithACounterweight) {
    const Wrench wrench = holdingWrench({}, {{0.01, 0, 0}, expRotation({0.3, 0.2, 0.1})});
    EXPECT_EQ(wrench.force, Eigen::Vector3d::Zero());
    EXPECT_EQ(wrench.torque, Eigen::Vector3d::Zero());
}

TEST(Gravity, HoldsUpWhatFallsDown) {
    const MovingWeight weight{.mass = 0.5, .centre_T = {0.02, 0, 0}};
    const Wrench wrench = holdingWrench(weight, Pose{});
    EXPECT_NEAR(wrench.force.z(), 0.5 * 9.80665, 1e-12);
    EXPECT_NEAR(wrench.torque.y(), -0.02 * 0.5 * 9.80665, 1e-12);
}

// J, zero with the weight's centre at D's origin.
double potentialEnergy(const MovingWeight& weight, const Pose& X_DT) {
    return -weight.mass * kStandardGravity * weight.down_D.dot(X_DT * weight.centre_T);
}

TEST(Gravity, IsTheGradientOfThePotentialEnergy) {
    std::mt19937 random(5);
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 200; ++i) {
        const MovingWeight weight{.mass = 0.4,
                                  .centre_T = 0.05 * test::randomVector(random),
                                  .down_D = test::randomDirection(random)};
        const Pose X_DT{0.03 * test::randomVector(random), expRotation(test::randomDirection(random))};
        const Wrench wrench = holdingWrench(weight, X_DT);
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k), none = Eigen::Vector3d::Zero();
            const auto slope = [&](const Pose& above, const Pose& below) {
                return (potentialEnergy(weight, above) - potentialEnergy(weight, below)) / (2 * kStep);
            };
            EXPECT_NEAR(wrench.force[k], slope(X_DT.incremented(step, none), X_DT.incremented(-step, none)),
                        1e-8);
            EXPECT_NEAR(wrench.torque[k], slope(X_DT.incremented(none, step), X_DT.incremented(none, -step)),
                        1e-8);
        }
    }
}

}  // namespace
}  // namespace bonemill
