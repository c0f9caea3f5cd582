#include "haptic_server/core/coupling/thesis_2012_coupling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bonemill {
namespace {

const Pose kSpo{{0.01, -0.02, 0.03}, expRotation({0.3, -0.2, 0.5})};
const Pose kDevice{{0.012, -0.021, 0.0295}, expRotation({0.1, 0.4, 0.9})};

Vector6d asVector(const Wrench& w) {
    return (Vector6d() << w.force, w.torque).finished();
}

TEST(VirtualCoupling, PullsTheToolToTheDevice) {
    const CouplingConfig config;
    const Wrench w =
        couplingWrench(config, kSpo, {kSpo.position + Eigen::Vector3d(1e-3, 0, 0), kSpo.rotation});
    EXPECT_NEAR(w.force.x(), 3.0, 1e-12);  // 3 N/mm
    EXPECT_NEAR(w.force.tail<2>().norm() + w.torque.norm(), 0, 1e-12);
}

TEST(VirtualCoupling, TorqueIsTheQuaternionVectorPart) {
    const CouplingConfig config;
    for (const double angle : {0.01, 0.5, 2.0, 3.0}) {
        const Pose turned{kSpo.position, expRotation({0, 0, angle}) * kSpo.rotation};
        EXPECT_NEAR(couplingWrench(config, kSpo, turned).torque.z(), std::sin(angle / 2), 1e-12);
        // The quaternion -q is the same orientation of the device.
        const Pose negated{turned.position, Eigen::Quaterniond(-turned.rotation.coeffs())};
        EXPECT_NEAR(couplingWrench(config, kSpo, negated).torque.z(), std::sin(angle / 2), 1e-12);
    }
}

TEST(VirtualCoupling, DerivativeMatchesFiniteDifferences) {
    const CouplingConfig config;
    const Matrix6d derivative = couplingDerivative(config, kSpo, kDevice);
    constexpr double kStep = 1e-6;
    for (int column = 0; column < 6; ++column) {
        Vector6d e = Vector6d::Zero();
        e[column] = kStep;
        const Vector6d plus =
            asVector(couplingWrench(config, kSpo.incremented(e.head<3>(), e.tail<3>()), kDevice));
        const Vector6d minus =
            asVector(couplingWrench(config, kSpo.incremented(-e.head<3>(), -e.tail<3>()), kDevice));
        const Vector6d numeric = (plus - minus) / (2 * kStep);
        EXPECT_LT((derivative.col(column) - numeric).norm(), 1e-5 * (1 + numeric.norm())) << column;
    }
}

TEST(Equilibrium, LandsWhereTheLinearForcesVanish) {
    const CouplingConfig config{.max_speed = 1e3, .max_angular_speed = 1e3};
    Matrix6d derivative = couplingDerivative(config, kSpo, kDevice);
    derivative.topLeftCorner<3, 3>() -= 5000 * Eigen::Vector3d(0.6, 0, 0.8) * Eigen::RowVector3d(0.6, 0, 0.8);
    const Wrench w = couplingWrench(config, kSpo, kDevice);
    const EquilibriumStep solved = solveEquilibrium(config, w, derivative, 1e-3);
    ASSERT_TRUE(solved.is_regular);
    EXPECT_FALSE(solved.is_clamped);
    EXPECT_LT((asVector(w) + derivative * solved.step).norm(), 1e-12);
}

TEST(Equilibrium, ClampsSpeedKeepingDirection) {
    const CouplingConfig config;
    const Pose far{kSpo.position + Eigen::Vector3d(0.03, 0.04, 0), expRotation({0, 0, 1}) * kSpo.rotation};
    const EquilibriumStep solved = solveEquilibrium(config, couplingWrench(config, kSpo, far),
                                                    couplingDerivative(config, kSpo, far), 1e-3);
    ASSERT_TRUE(solved.is_regular && solved.is_clamped);
    EXPECT_NEAR(solved.step.head<3>().norm(), 0.5e-3, 1e-12);
    EXPECT_LT((solved.step.head<3>().normalized() - Eigen::Vector3d(0.6, 0.8, 0)).norm(), 1e-9);
    EXPECT_NEAR(solved.step.tail<3>().norm(), 240 * M_PI / 180 * 1e-3,
                1e-8);  // 0.00419 rad, not the printed 0.073
}

TEST(Equilibrium, SaysNoToSingularAndNonFinite) {
    const CouplingConfig config;
    EXPECT_FALSE(solveEquilibrium(config, {{1, 0, 0}, {0, 0, 0}}, Matrix6d::Zero(), 1e-3).is_regular);
    Matrix6d m = couplingDerivative(config, kSpo, kDevice);
    m(2, 3) = std::numeric_limits<double>::quiet_NaN();
    const EquilibriumStep solved = solveEquilibrium(config, {{1, 0, 0}, {0, 0, 0}}, m, 1e-3);
    EXPECT_FALSE(solved.is_regular || solved.is_found);
    EXPECT_EQ(solved.step.norm(), 0);
    const Wrench infinite{{std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 0}};
    EXPECT_FALSE(
        solveEquilibrium(config, infinite, couplingDerivative(config, kSpo, kDevice), 1e-3).is_regular);
}

TEST(Equilibrium, MovesOnWhenTheToolIsExactlyHalfATurnAway) {
    const CouplingConfig config;
    const Pose spo;
    const Pose opposite{{1e-4, 0, 0},
                        Eigen::Quaterniond(0, 0, 0, 1)};  // 180° about z: the rotation block is singular
    const EquilibriumStep solved = solveEquilibrium(config, couplingWrench(config, spo, opposite),
                                                    couplingDerivative(config, spo, opposite), 1e-3);
    EXPECT_FALSE(solved.is_regular);
    EXPECT_TRUE(solved.is_found);
    EXPECT_NEAR(solved.step.x(), 1e-4, 1e-8);
    EXPECT_NEAR(std::abs(solved.step[5]), config.max_angular_speed * 1e-3, 1e-9);
}

}  // namespace
}  // namespace bonemill
