#include "haptic_server/scene/setup/scene_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bonemill {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The oracle sums pressure κ times depth over the cap of a ball.
TEST(WallForce, IsTheBallsForceAtHalfTheWall) {
    const double kappa = 1e12, radius = 1e-3, wall = 0.3e-3;
    double force = 0;
    constexpr int kRings = 20'000;
    const double depth = wall / 2, rim = std::sqrt(2 * radius * depth - depth * depth);
    for (int n = 0; n < kRings; ++n) {
        const double r = (n + 0.5) / kRings * rim;
        const double to_center = std::hypot(radius - depth, r);
        const double upward = (radius - depth) / to_center;
        force += kappa * (radius - to_center) * upward * 2 * M_PI * r * rim / kRings;
    }
    const double computed =
        wallForce({.stiffness_per_area = kappa, .stiffness_cap = kInfinity}, radius, wall);
    EXPECT_NEAR(computed, force, 1e-6 * force);
}

TEST(WallForce, IsBoundedByTheStiffnessCapAndByThinTools) {
    const GradientContactConfig stiff{.stiffness_per_area = 1e12, .stiffness_cap = kInfinity};
    EXPECT_DOUBLE_EQ(wallForce({.stiffness_per_area = 1e12, .stiffness_cap = 1e4}, 1e-3, 0.125e-3), 0.625);
    EXPECT_LT(wallForce(stiff, 0.1e-3, 0.125e-3), wallForce(stiff, 1e-3, 0.125e-3) / 20);
    // A wall thicker than the ball carries no more than the most that the ball can.
    EXPECT_DOUBLE_EQ(wallForce(stiff, 0.1e-3, 1e-3), wallForce(stiff, 0.1e-3, 2e-3));
}

// A large burr pulls as hard as the wall of a voxel carries, a small one no harder than holds it off solid
// bone.
TEST(SaturationForce, LeavesASmallBurrRoom) {
    scene::Scene scene;
    scene.mutable_coupling()->set_max_force_n(1000);
    const GradientContactConfig contact = gradientConfigOf(scene).contact;
    for (const double voxel : {0.1e-3, 0.25e-3, 1e-3})
        for (const double radius : {0.5, 1.0, 2.0, 5.0, 20.0}) {
            scene::Tool tool;
            tool.set_burr_radius_mm(radius * voxel / kMillimetre);
            const double force = saturationForceOf(scene, tool, voxel);
            EXPECT_LE(force, 0.41 * mostCarried(contact, radius * voxel)) << radius;
            EXPECT_LE(force, wallForce(contact, radius * voxel, voxel)) << radius;
            if (radius >= 5 && force < 999) {
                EXPECT_DOUBLE_EQ(force, wallForce(contact, radius * voxel, voxel)) << radius;
            }
        }
}

TEST(ThinnestWall, IsTheScenesElseOneVoxel) {
    scene::Scene scene;
    EXPECT_DOUBLE_EQ(thinnestWall(scene, 0.3e-3), 0.3e-3);
    scene.mutable_contact()->set_thinnest_wall_mm(0.8);
    EXPECT_DOUBLE_EQ(thinnestWall(scene, 0.3e-3), 0.8e-3);
}

}  // namespace
}  // namespace bonemill
