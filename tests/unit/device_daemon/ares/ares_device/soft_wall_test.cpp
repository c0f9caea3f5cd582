#include "device_daemon/ares/ares_device/soft_wall.h"

#include <gtest/gtest.h>

#include <random>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/units.h"
#include "tests/support/random_direction.h"

namespace bonemill {
namespace {

class SoftWalls : public testing::Test {
  protected:
    WallReaction at(const Pose& X_DT, const Vector6d& twist = Vector6d::Zero()) const {
        Matrix6d J_inv;
        EXPECT_TRUE(kinematics.inverseJacobian(X_DT, J_inv));
        return walls.at(X_DT, J_inv, twist);
    }
    // Draws a mechanical pose that touches a wall, or lies up to 0.5 mm beyond a stop.
    Pose touching() {
        for (;;) {
            const Pose X_DT{0.04 * test::randomVector(random),
                            expRotation(0.9 * kMaxTurn * uniform() * test::randomDirection(random))};
            Matrix6d J_inv;
            if (kinematics.workspaceFaults(X_DT, 0.5e-3) != kWorkspaceOk ||
                !kinematics.inverseJacobian(X_DT, J_inv) || !kinematics.isOwnAssembly(J_inv) ||
                singularityIndex(J_inv) < kMinSingularityIndex) {
                continue;
            }
            if (walls.at(X_DT, J_inv, Vector6d::Zero()).touches) return X_DT;
        }
    }
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random); }

    AresKinematics kinematics;
    SoftWall walls{kinematics, {}};
    std::mt19937 random{17};
};

TEST_F(SoftWalls, AreNotFeltInTheSpecifiedWorkspace) {
    int touched = 0;
    constexpr int kPoses = 20000;
    for (int i = 0; i < kPoses; ++i) {
        Pose X_DT;
        for (double& coordinate : X_DT.position) coordinate = 0.025 * (2 * uniform() - 1);
        X_DT.rotation = expRotation(40 * kDegree * uniform() * test::randomDirection(random));
        touched += at(X_DT).touches;
    }
    EXPECT_LE(touched, kPoses / 200);  // extreme corners only
}

TEST_F(SoftWalls, PushIsTheGradientOfTheirEnergy) {
    constexpr double kStep = 1e-7;
    for (int i = 0; i < 300; ++i) {
        const Pose X_DT = touching();
        const WallReaction reaction = at(X_DT);
        for (int k = 0; k < 6; ++k) {
            const Vector6d step = kStep * Vector6d::Unit(k);
            const double above = at(X_DT.incremented(step.head<3>(), step.tail<3>())).energy;
            const double below = at(X_DT.incremented(-step.head<3>(), -step.tail<3>())).energy;
            const double push = k < 3 ? reaction.wrench_D.force[k] : reaction.wrench_D.torque[k - 3];
            EXPECT_NEAR(push, -(above - below) / (2 * kStep), 2e-5) << "pose " << i << ", component " << k;
        }
    }
}

TEST_F(SoftWalls, EachKindPushesBackInside) {
    const auto identity = Eigen::Quaterniond::Identity();
    const double end = kinematics.geometry().stroke / 2;
    EXPECT_LT(at({{0, 0, end - 1e-3}, identity}).wrench_D.force.z(), -1);
    EXPECT_GT(at({{0, 0, -end + 1e-3}, identity}).wrench_D.force.z(), 1);
    EXPECT_GT(at({{-0.103, 0, 0}, identity}).wrench_D.force.x(), 1);  // lean
    const Pose turned{{0, 0, 0}, expRotation({0, 0, kMaxTurn - 0.02})};
    EXPECT_LT(at(turned).wrench_D.torque.z(), -0.05);
}

TEST_F(SoftWalls, PushAwayFromSingularities) {
    int tried = 0;
    for (int i = 0; i < 20000 && tried < 50; ++i) {
        const Pose X_DT = touching();
        Matrix6d J_inv;
        ASSERT_TRUE(kinematics.inverseJacobian(X_DT, J_inv));
        const bool only_singular = kinematics.workspaceFaults(X_DT, -9e-3) == kWorkspaceOk &&
                                   logRotation(X_DT.rotation).norm() < kMaxTurn - 0.14;
        if (!only_singular || singularityIndex(J_inv) > 0.15) continue;
        ++tried;
        const Wrench push = at(X_DT).wrench_D;
        const Pose pushed = X_DT.incremented(1e-4 * push.force, 1e-2 * push.torque);
        Matrix6d J_inv_pushed;
        ASSERT_TRUE(kinematics.inverseJacobian(pushed, J_inv_pushed));
        EXPECT_GT(smoothIndex(J_inv_pushed), smoothIndex(J_inv));
    }
    EXPECT_EQ(tried, 50);
}

TEST_F(SoftWalls, ForceAndTorqueAreBounded) {
    double largest_force = 0, largest_torque = 0;
    for (int i = 0; i < 5000; ++i) {
        const Pose X_DT = touching();
        Vector6d twist;
        twist << 3 * test::randomVector(random), 30 * test::randomVector(random);
        const Wrench push = at(X_DT, twist).wrench_D;
        largest_force = std::max(largest_force, push.force.norm());
        largest_torque = std::max(largest_torque, push.torque.norm());
    }
    RecordProperty("largest_force_n", std::to_string(largest_force));
    RecordProperty("largest_torque_nm", std::to_string(largest_torque));
    // Several sliders in their walls, with links that lean far.
    EXPECT_LT(largest_force, 60);
    EXPECT_LT(largest_torque, 3);
}

// Along a closed path of the handle the springs give back what they took, and the dampers only take.
TEST_F(SoftWalls, AreTheirPassiveSelvesAroundClosedPaths) {
    constexpr int kSteps = 4000;
    constexpr double kPeriod = 1.0;  // s
    for (int path = 0; path < 30; ++path) {
        const Pose centre = touching();
        const Eigen::Vector3d a = 2e-3 * test::randomVector(random), b = 2e-3 * test::randomVector(random);
        const Eigen::Vector3d c = 0.03 * test::randomVector(random), d = 0.03 * test::randomVector(random);
        const auto poseAt = [&](int i) {
            const double s = kTurn * i / kSteps;
            return centre.incremented(a * std::sin(s) + b * std::sin(2 * s),
                                      c * std::sin(s) + d * std::sin(3 * s));
        };
        double by_springs = 0, by_all = 0, passed = 0;
        for (int i = 0; i < kSteps; ++i) {
            const Pose from = poseAt(i), to = poseAt(i + 1);
            const Eigen::Vector3d way = to.position - from.position;
            const Eigen::Vector3d turn = logRotation(to.rotation * from.rotation.conjugate());
            const Pose middle = from.incremented(way / 2, turn / 2);
            Vector6d twist;
            twist << way, turn;
            twist *= kSteps / kPeriod;
            if (kinematics.workspaceFaults(middle, 0.05) & kWorkspaceUnreachable)
                FAIL() << "left the mechanism";
            const Wrench spring = at(middle).wrench_D, all = at(middle, twist).wrench_D;
            by_springs += spring.force.dot(way) + spring.torque.dot(turn);
            by_all += all.force.dot(way) + all.torque.dot(turn);
            passed += std::abs(spring.force.dot(way) + spring.torque.dot(turn));
        }
        EXPECT_NEAR(by_springs, 0, 1e-5 + 1e-4 * passed) << path;
        EXPECT_LT(by_all, by_springs) << path;
    }
}

}  // namespace
}  // namespace bonemill
