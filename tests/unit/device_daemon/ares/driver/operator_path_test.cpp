#include <gtest/gtest.h>

#include "device_daemon/ares/driver/ares_emulator.h"

namespace bonemill {
namespace {

std::vector<Waypoint> threeWaypoints() {
    return {{1.0, {{0, 0, 0.01}, Eigen::Quaterniond::Identity()}, 0},
            {3.0, {{0.02, 0, 0.01}, expRotation({0, 0.6, 0})}, 1},
            {3.5, {{0.02, 0, 0}, expRotation({0, 0.6, 0})}, 2}};
}

TEST(OperatorPath, RestsBeforeTheFirstAndAfterTheLastWaypoint) {
    const OperatorPath path(threeWaypoints());
    const HandTarget before = path.at(0.5);
    EXPECT_EQ(before.waypoint, -1);
    EXPECT_EQ(before.buttons, 0u);
    EXPECT_EQ(before.X_DT.position, Eigen::Vector3d(0, 0, 0.01));
    EXPECT_EQ(before.v_DT, Eigen::Vector3d::Zero());
    const HandTarget after = path.at(99);
    EXPECT_EQ(after.waypoint, 2);
    EXPECT_EQ(after.buttons, 2u);
    EXPECT_EQ(after.X_DT.position, Eigen::Vector3d(0.02, 0, 0));
    EXPECT_EQ(after.v_DT, Eigen::Vector3d::Zero());
    EXPECT_EQ(path.duration(), 3.5);
}

TEST(OperatorPath, PassesHalfWayAtHalfTime) {
    const HandTarget middle = OperatorPath(threeWaypoints()).at(2.0);
    EXPECT_EQ(middle.waypoint, 0);
    EXPECT_LT((middle.X_DT.position - Eigen::Vector3d(0.01, 0, 0.01)).norm(), 1e-15);
    EXPECT_LT((logRotation(middle.X_DT.rotation) - Eigen::Vector3d(0, 0.3, 0)).norm(), 1e-14);
    EXPECT_NEAR(middle.v_DT.x(), 1.5 * 0.02 / 2.0, 1e-15);  // smoothstep is fastest there: 3/2 of the mean
}

TEST(OperatorPath, VelocityIsTheDerivativeAlsoWithTremor) {
    constexpr double kStep = 1e-6;
    for (const double tremor : {0.0, 2e-4}) {
        const OperatorPath path(threeWaypoints(), tremor);
        for (double t = 1.05; t < 3.45; t += 0.1) {
            const HandTarget before = path.at(t - kStep), now = path.at(t), after = path.at(t + kStep);
            const Eigen::Vector3d v = (after.X_DT.position - before.X_DT.position) / (2 * kStep);
            const Eigen::Vector3d w =
                logRotation(after.X_DT.rotation * before.X_DT.rotation.conjugate()) / (2 * kStep);
            EXPECT_LT((v - now.v_DT).norm(), 1e-7) << t;
            EXPECT_LT((w - now.w_DT).norm(), 1e-7) << t;
        }
    }
}

TEST(OperatorPath, StopsAtEveryWaypoint) {
    const OperatorPath path(threeWaypoints());
    for (const Waypoint& waypoint : threeWaypoints()) {
        const HandTarget target = path.at(waypoint.time);
        EXPECT_LT((target.X_DT.position - waypoint.X_DT.position).norm(), 1e-15);
        EXPECT_EQ(target.v_DT.norm() + target.w_DT.norm(), 0);
    }
}

TEST(OperatorPath, TurnsTheShortWayBetweenOppositeQuaternionSigns) {
    std::vector<Waypoint> waypoints = threeWaypoints();
    waypoints[1].X_DT.rotation.coeffs() *= -1;
    const OperatorPath path(waypoints);
    EXPECT_LT((logRotation(path.at(2.0).X_DT.rotation) - Eigen::Vector3d(0, 0.3, 0)).norm(), 1e-14);
}

TEST(OperatorPath, TremorIsBoundedRepeatableAndPresent) {
    constexpr double kTremor = 1e-4;
    const OperatorPath path({}, kTremor), again({}, kTremor);
    double largest = 0;
    for (double t = 0; t < 2; t += 1e-3) {
        const Eigen::Vector3d p = path.at(t).X_DT.position;
        largest = std::max(largest, p.cwiseAbs().maxCoeff());
        EXPECT_EQ(p, again.at(t).X_DT.position);
    }
    EXPECT_LE(largest, kTremor);
    EXPECT_GT(largest, kTremor / 2);
}

TEST(OperatorPath, WithoutWaypointsRestsAtTheOrigin) {
    const OperatorPath path;
    EXPECT_EQ(path.duration(), 0);
    EXPECT_EQ(path.at(5).X_DT.position, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace bonemill
