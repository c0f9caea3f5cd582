#include "common/ares_kinematics/ares_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace bonemill {
namespace {

constexpr double kSpecifiedHalfRange = 0.025;                       // m: 50 x 50 x 50 mm
constexpr double kSpecifiedRotation = 40 * std::numbers::pi / 180;  // rad, about any axis
constexpr double kSpecifiedForce = 50;                              // N
constexpr double kSpecifiedTorque = 1;                              // N·m

class PoseSampler {
  public:
    Pose next() {
        std::uniform_real_distribution<double> uniform(-1, 1);
        std::normal_distribution<double> normal;
        Pose X_DT;
        for (double& coordinate : X_DT.position) coordinate = kSpecifiedHalfRange * uniform(generator_);
        const Eigen::Vector3d axis(normal(generator_), normal(generator_), normal(generator_));
        X_DT.rotation = expRotation(axis.normalized() * (kSpecifiedRotation * uniform(generator_)));
        return X_DT;
    }
    Vector6d nextTwist() {
        std::normal_distribution<double> normal;
        Vector6d twist;
        for (double& component : twist) component = normal(generator_);
        return twist;
    }

  private:
    std::mt19937_64 generator_{20120101};
};

Matrix6d jacobianAt(const AresKinematics& kinematics, const Pose& X_DT) {
    Matrix6d J_inv;
    EXPECT_TRUE(kinematics.inverseJacobian(X_DT, J_inv));
    return J_inv;
}

TEST(AresKinematics, NeutralPoseIsTheMiddleOfEveryStroke) {
    const AresKinematics kinematics;
    ASSERT_TRUE(kinematics.isBuildable());
    Vector6d q;
    ASSERT_TRUE(kinematics.inverse(Pose{}, q));
    for (const double slider : q) EXPECT_NEAR(slider, kinematics.geometry().stroke / 2, 1e-15);
}

TEST(AresKinematics, RaisingThePlatformRaisesEverySliderAlike) {
    const AresKinematics kinematics;
    Vector6d q;
    ASSERT_TRUE(kinematics.inverse({{0, 0, 0.02}, Eigen::Quaterniond::Identity()}, q));
    for (const double slider : q) EXPECT_NEAR(slider, kinematics.geometry().stroke / 2 + 0.02, 1e-15);
}

TEST(AresKinematics, JacobianMatchesFiniteDifferences) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 200; ++i) {
        const Pose X_DT = sampler.next();
        const Matrix6d J_inv = jacobianAt(kinematics, X_DT);
        for (int k = 0; k < 6; ++k) {
            const Vector6d step = kStep * Vector6d::Unit(k);
            Vector6d above, below;
            ASSERT_TRUE(kinematics.inverse(X_DT.incremented(step.head<3>(), step.tail<3>()), above));
            ASSERT_TRUE(kinematics.inverse(X_DT.incremented(-step.head<3>(), -step.tail<3>()), below));
            const Vector6d difference = (above - below) / (2 * kStep);
            EXPECT_LT((difference - J_inv.col(k)).cwiseAbs().maxCoeff(), 1e-8) << "column " << k;
        }
    }
}

// Compares an analytic gradient over the twist with central differences of `value`.
template <typename Gradient, typename Value>
void expectGradient(const Gradient& gradient, const Pose& X_DT, double tolerance, Value value) {
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
        const Vector6d step = kStep * Vector6d::Unit(k);
        const auto above = value(X_DT.incremented(step.head<3>(), step.tail<3>()));
        const auto below = value(X_DT.incremented(-step.head<3>(), -step.tail<3>()));
        EXPECT_LT(((above - below) / (2 * kStep) - gradient(k)).cwiseAbs().maxCoeff(), tolerance) << k;
    }
}

TEST(AresKinematics, JacobianGradientMatchesFiniteDifferences) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    for (int i = 0; i < 200; ++i) {
        const Pose X_DT = sampler.next();
        std::array<Matrix6d, 6> gradient;
        ASSERT_TRUE(kinematics.inverseJacobianGradient(X_DT, gradient));
        expectGradient([&](int k) -> const Matrix6d& { return gradient[k]; }, X_DT, 1e-6,
                       [&](const Pose& near) -> Matrix6d { return jacobianAt(kinematics, near); });
    }
}

TEST(AresKinematics, LinkHeightsAndTheirGradientMatchTheLinks) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    const auto heightsAt = [&](const Pose& X_DT) -> Vector6d {
        Vector6d heights;
        Matrix6d unused;
        EXPECT_TRUE(kinematics.linkHeights(X_DT, heights, unused));
        return heights;
    };
    for (int i = 0; i < 200; ++i) {
        const Pose X_DT = sampler.next();
        Vector6d heights, q_low;
        Matrix6d gradient;
        ASSERT_TRUE(kinematics.linkHeights(X_DT, heights, gradient));
        expectGradient([&](int k) -> Vector6d { return gradient.col(k); }, X_DT, 1e-8, heightsAt);
        // The links, not the sliders, make up for a shift across the actuators.
        ASSERT_TRUE(kinematics.inverse(X_DT, q_low));
        EXPECT_LE(heights.maxCoeff(), kinematics.geometry().link_length);
    }
}

TEST(AresKinematics, ActuatorsAndHandExchangeTheSamePower) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    for (int i = 0; i < 200; ++i) {
        const Matrix6d J_inv = jacobianAt(kinematics, sampler.next());
        const Vector6d w = sampler.nextTwist();
        const Vector6d twist = sampler.nextTwist();
        const Vector6d forces = actuatorForces(J_inv, {w.head<3>(), w.tail<3>()});
        EXPECT_NEAR(forces.dot(J_inv * twist), w.dot(twist), 1e-9);
        const Wrench back = wrenchOf(J_inv, forces);
        EXPECT_LT((back.force - w.head<3>()).norm() + (back.torque - w.tail<3>()).norm(), 1e-9);
    }
}

TEST(AresKinematics, StaysFarFromSingularitiesAndWithinTheActuatorsForce) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    double worst_index = 1, worst_for_force = 0, worst_for_torque = 0;
    int outside_stroke = 0;
    constexpr int kPoses = 4000;
    for (int i = 0; i < kPoses; ++i) {
        const Pose X_DT = sampler.next();
        const Matrix6d J_inv = jacobianAt(kinematics, X_DT);
        EXPECT_EQ(kinematics.workspaceFaults(X_DT) & ~kWorkspaceStroke, 0u);
        outside_stroke += kinematics.workspaceFaults(X_DT) != kWorkspaceOk;
        worst_index = std::min(worst_index, singularityIndex(J_inv));
        // Actuator i needs at most |row i| per unit of wrench, whatever the wrench's direction.
        Matrix6d forces_per_wrench;
        for (int k = 0; k < 6; ++k) {
            const Vector6d w = Vector6d::Unit(k);
            forces_per_wrench.col(k) = actuatorForces(J_inv, {w.head<3>(), w.tail<3>()});
        }
        for (int k = 0; k < kLegCount; ++k) {
            worst_for_force =
                std::max(worst_for_force, kSpecifiedForce * forces_per_wrench.row(k).head<3>().norm());
            worst_for_torque =
                std::max(worst_for_torque, kSpecifiedTorque * forces_per_wrench.row(k).tail<3>().norm());
        }
    }
    EXPECT_GE(worst_index, 0.22);
    EXPECT_LE(worst_for_force, 48);
    EXPECT_LE(worst_for_torque, 19);
    EXPECT_LE(outside_stroke, kPoses / 1000);  // extreme corners only
    RecordProperty("singularity_index", std::to_string(worst_index));
    RecordProperty("actuator_n_for_50_n", std::to_string(worst_for_force));
    RecordProperty("actuator_n_for_1_nm", std::to_string(worst_for_torque));
}

TEST(AresKinematics, ForwardNeedsFewIterations) {
    const AresKinematics kinematics;
    PoseSampler sampler;
    for (int i = 0; i < 1000; ++i) {
        const Pose X_DT = sampler.next();
        Vector6d q;
        ASSERT_TRUE(kinematics.inverse(X_DT, q));
        const ForwardSolution cold = kinematics.forward(q, Pose{});
        EXPECT_TRUE(cold.converged);
        EXPECT_LE(cold.iterations, 5);
        // This pose is one loop period at 0.5 m/s and 240 deg/s away.
        const ForwardSolution warm = kinematics.forward(q, X_DT.incremented({5e-4, 0, 0}, {0, 4.2e-3, 0}));
        EXPECT_TRUE(warm.converged);
        EXPECT_LE(warm.iterations, 2);
    }
}

TEST(AresKinematics, SaysThatALinkIsTooShort) {
    const AresKinematics kinematics;
    const Pose far{{0.2, 0, 0}, Eigen::Quaterniond::Identity()};
    Vector6d q;
    Matrix6d J_inv;
    EXPECT_FALSE(kinematics.inverse(far, q));
    EXPECT_FALSE(kinematics.inverseJacobian(far, J_inv));
    EXPECT_EQ(kinematics.workspaceFaults(far), kWorkspaceUnreachable);
}

TEST(AresKinematics, ReportsStrokeAndLean) {
    const AresKinematics kinematics;
    const double half_stroke = kinematics.geometry().stroke / 2;
    const auto identity = Eigen::Quaterniond::Identity();
    EXPECT_EQ(kinematics.workspaceFaults({{0, 0, half_stroke - 1e-6}, identity}), kWorkspaceOk);
    EXPECT_EQ(kinematics.workspaceFaults({{0, 0, half_stroke + 1e-6}, identity}), kWorkspaceStroke);
    EXPECT_EQ(kinematics.workspaceFaults({{0, 0, -half_stroke - 1e-6}, identity}), kWorkspaceStroke);
    // Away from the pair at 0 degrees, that pair's links lean to 0.42 at 104 mm and are too short at 123 mm.
    EXPECT_FALSE(kinematics.workspaceFaults({{-0.102, 0, 0}, identity}) & kWorkspaceLean);
    EXPECT_TRUE(kinematics.workspaceFaults({{-0.110, 0, 0}, identity}) & kWorkspaceLean);
    EXPECT_EQ(kinematics.workspaceFaults({{-0.130, 0, 0}, identity}), kWorkspaceUnreachable);
}

TEST(AresKinematics, SlackWidensStrokeAndLean) {
    const AresKinematics kinematics;
    const Pose above{{0, 0, kinematics.geometry().stroke / 2 + 0.5e-3}, Eigen::Quaterniond::Identity()};
    EXPECT_EQ(kinematics.workspaceFaults(above), kWorkspaceStroke);
    EXPECT_EQ(kinematics.workspaceFaults(above, 1e-3), kWorkspaceOk);
    const Pose below{{0, 0, kinematics.geometry().stroke / 2 - 0.5e-3}, Eigen::Quaterniond::Identity()};
    EXPECT_EQ(kinematics.workspaceFaults(below), kWorkspaceOk);
    EXPECT_EQ(kinematics.workspaceFaults(below, -1e-3), kWorkspaceStroke);
}

TEST(AresKinematics, ReportsATurnThatIsTooFar) {
    const AresKinematics kinematics;
    for (const double sign : {-1.0, 1.0}) {
        const auto turned = [&](double angle) { return Pose{{0, 0, 0}, expRotation({0, 0, sign * angle})}; };
        EXPECT_FALSE(kinematics.workspaceFaults(turned(kMaxTurn - 1e-3)) & kWorkspaceTurn);
        EXPECT_TRUE(kinematics.workspaceFaults(turned(kMaxTurn + 1e-3)) & kWorkspaceTurn);
    }
}

TEST(AresKinematics, ForwardOfImpossibleJointsDoesNotConverge) {
    const AresKinematics kinematics;
    Vector6d q = Vector6d::Constant(kinematics.geometry().stroke / 2);
    q[0] += 0.5;
    EXPECT_FALSE(kinematics.forward(q, Pose{}).converged);
    q[0] = std::numeric_limits<double>::quiet_NaN();
    const ForwardSolution solution = kinematics.forward(q, Pose{});
    EXPECT_FALSE(solution.converged);
    EXPECT_TRUE(solution.X_DT.isFinite());
}

TEST(AresKinematics, RefusesAGeometryThatCannotBeBuilt) {
    AresGeometry geometry;
    geometry.link_length = 0.05;
    EXPECT_FALSE(AresKinematics(geometry).isBuildable());
}

TEST(AresKinematics, RefusesAGeometryWhoseLegsDoNotHoldThePlatform) {
    AresGeometry geometry;
    geometry.platform_half_angle = geometry.base_half_angle;  // turned about z, all links lean alike
    EXPECT_FALSE(AresKinematics(geometry).isBuildable());
}

}  // namespace
}  // namespace bonemill
