#include "common/geometry/hand_space.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

constexpr double kScales[] = {0.05, 0.3, 1, 3, 20};

TEST(HandSpace, TheToolGoesSoManyTimesAsFarAndTurnsAlike) {
    const Pose X_DT{{1, -2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)};
    const Pose at_tool = HandSpace(4).poseAtTool(X_DT);
    EXPECT_EQ(at_tool.position, Eigen::Vector3d(4, -8, 12));
    EXPECT_EQ(at_tool.rotation.coeffs(), X_DT.rotation.coeffs());
}

// Else a closed path of the hand could gain energy.
TEST(HandSpace, TheHandsPowerIsTheSameShareOfTheToolsInTranslationAndRotation) {
    const Eigen::Vector3d force(1, 2, 3), torque(0.1, -0.2, 0.3), v_tool(0.1, 0.2, -0.4), w(1, -2, 0.5);
    for (const double scale : kScales) {
        const HandSpace space(scale);
        EXPECT_NEAR(force.dot(space.wayAtHand(v_tool)), force.dot(v_tool) / scale, 1e-12) << scale;
        EXPECT_NEAR(space.torqueAtHand(torque).dot(w), torque.dot(w) / scale, 1e-12) << scale;
    }
}

// A spring gives the same force, and the torque over the scale, whichever side its stretch is seen from.
TEST(HandSpace, SpringsGiveTheSameForceOnEitherSide) {
    constexpr double kStiffness = 700, kRotationStiffness = 0.4, kWay = 2e-3, kTurn = 0.1;
    for (const double scale : kScales) {
        const HandSpace space(scale);
        EXPECT_NEAR(space.forcePerWayAtHand(kStiffness) * kWay, kStiffness * space.wayAtTool(kWay), 1e-12)
            << scale;
        EXPECT_NEAR(space.torqueAtHand(kRotationStiffness) * kTurn,
                    space.torqueAtHand(kRotationStiffness * kTurn), 1e-12)
            << scale;
    }
}

TEST(HandSpace, LeadsBackToWhereItCameFrom) {
    for (const double scale : kScales) {
        const HandSpace space(scale);
        EXPECT_DOUBLE_EQ(space.wayAtHand(space.wayAtTool(0.7)), 0.7);
        EXPECT_DOUBLE_EQ(space.forcePerWayAtHand(space.forcePerWayAtTool(0.7)), 0.7);
        EXPECT_DOUBLE_EQ(space.torqueAtHand(space.torqueAtTool(0.7)), 0.7);
    }
}

}  // namespace
}  // namespace bonemill
