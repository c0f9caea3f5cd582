#include "haptic_server/core/coupling/energy_coupling.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/eigenvalues.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

EnergyCoupling couplingWithGrip() {
    EnergyCoupling config;
    config.saturation_force = 9;
    config.saturation_torque = 0.4;
    config.p_TG = Vector3d(0.01, 0.06, -0.02);
    return config;
}

Pose randomPose(std::mt19937& random, double translation, double rotation) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
    return {translation * vector(), expRotation(rotation * vector())};
}

template <class Energy>
Vector6d minusGradient(Energy&& energy, const Pose& at) {
    constexpr double kStep = 1e-7;
    Vector6d w;
    for (int i = 0; i < 6; ++i) {
        Vector6d step = Vector6d::Zero();
        step[i] = kStep;
        const double ahead = energy(at.incremented(step.head<3>(), step.tail<3>()));
        const double behind = energy(at.incremented(-step.head<3>(), -step.tail<3>()));
        w[i] = -(ahead - behind) / (2 * kStep);
    }
    return w;
}

TEST(EnergyCoupling, WrenchesOnToolAndDeviceAreTheEnergysGradients) {
    const EnergyCoupling config = couplingWithGrip();
    const ContinuousRotation way;
    std::mt19937 random(5);
    for (int n = 0; n < 200; ++n) {
        const Pose spo = randomPose(random, 0.01, 1), device = randomPose(random, 0.01, 1);
        const auto by_tool = [&](const Pose& pose) {
            return couplingEnergy(config, pose, device, way).energy;
        };
        const auto by_device = [&](const Pose& pose) {
            return couplingEnergy(config, spo, pose, way).energy;
        };
        const Vector6d tool = minusGradient(by_tool, spo), hand = minusGradient(by_device, device);
        EXPECT_LT((stacked(couplingEnergy(config, spo, device, way).wrench) - tool).norm(),
                  1e-6 * tool.norm() + 1e-7);
        EXPECT_LT((stacked(couplingWrenchOnDevice(config, spo, device, way)) - hand).norm(),
                  1e-6 * hand.norm() + 1e-7);
    }
}

TEST(EnergyCoupling, DampingIsTheGradientOfItsEnergy) {
    const EnergyCoupling config = couplingWithGrip();
    std::mt19937 random(6);
    for (int n = 0; n < 100; ++n) {
        const Pose before = randomPose(random, 0.01, 2), spo = randomPose(random, 0.01, 2);
        const auto energy = [&](const Pose& pose) {
            return dampingEnergy(config, pose, before, 1e-3).energy;
        };
        const Vector6d w = minusGradient(energy, spo);
        EXPECT_LT((stacked(dampingEnergy(config, spo, before, 1e-3).wrench) - w).norm(), 1e-6 * w.norm());
    }
}

TEST(EnergyCoupling, StiffnessIsExactForSmallStretchAndAlwaysPositive) {
    EnergyCoupling config = couplingWithGrip();
    const ContinuousRotation way;
    const Pose rest{{0.1, 0.2, 0.3}, expRotation({0.3, -0.8, 0.5})};
    const EnergyTerm at_rest = couplingEnergy(config, rest, rest, way);
    for (int i = 0; i < 6; ++i) {
        Vector6d step = Vector6d::Zero();
        step[i] = 1e-6;
        const Pose moved = rest.incremented(step.head<3>(), step.tail<3>());
        const Vector6d change = stacked(couplingEnergy(config, moved, rest, way).wrench) / 1e-6;
        EXPECT_LT((change + at_rest.stiffness.col(i)).norm(), 1e-3 * at_rest.stiffness.norm());
    }
    std::mt19937 random(8);
    for (int n = 0; n < 500; ++n) {
        const EnergyTerm term =
            couplingEnergy(config, randomPose(random, 0.05, 3), randomPose(random, 0.05, 3), way);
        EXPECT_GT(test::eigenvaluesOf(term.stiffness)[0], 0);
        EXPECT_LT((term.stiffness - term.stiffness.transpose()).norm(), 1e-9 * term.stiffness.norm());
    }
}

TEST(EnergyCoupling, ForceAndTorqueSaturate) {
    const EnergyCoupling config{{.saturation_torque = 0.3}, 9};
    const Pose spo, far{{1, 0, 0}, expRotation({0, 2.5, 0})};
    const Wrench wrench = couplingEnergy(config, spo, far, {}).wrench;
    EXPECT_NEAR(wrench.force.x(), 9, 1e-9);
    EXPECT_LE(wrench.torque.norm(), 0.3);
    EXPECT_GT(wrench.torque.norm(), 0.299);
    EXPECT_TRUE(std::isfinite(couplingEnergy(config, spo, {{1e3, 0, 0}, spo.rotation}, {}).energy));
}

TEST(ContinuousRotation, GoesOnBeyondHalfATurn) {
    ContinuousRotation way;
    const Vector3d axis = Vector3d(1, 2, -1).normalized();
    double before = 0;
    for (double angle = 0; angle < 4.4; angle += 0.05) {
        const Eigen::Quaterniond rotation = expRotation(angle * axis);
        const Vector3d log = way.log(rotation);
        EXPECT_NEAR(log.dot(axis), angle, 1e-9);
        EXPECT_NEAR(log.norm(), angle, 1e-9);
        EXPECT_LT(angle - before, 0.051);
        before = angle;
        way.remember(rotation);
    }
    const Vector3d far = way.log(expRotation(4.6 * axis));  // beyond kLongestWay: the short way
    EXPECT_NEAR(far.dot(axis), 4.6 - 2 * M_PI, 1e-9);
}

TEST(ContinuousRotation, WithoutMemoryItIsTheShorterWay) {
    std::mt19937 random(9);
    for (int n = 0; n < 200; ++n) {
        const Eigen::Quaterniond q = randomPose(random, 0, 3).rotation;
        EXPECT_LT((ContinuousRotation().log(q) - logRotation(q)).norm(), 1e-9);
        EXPECT_LT((ContinuousRotation().log(Eigen::Quaterniond(-q.coeffs())) - logRotation(q)).norm(), 1e-9);
    }
    EXPECT_LT(ContinuousRotation().log(expRotation({1e-10, 0, 2e-10})).norm(), 3e-10);
}

}  // namespace
}  // namespace bonemill
