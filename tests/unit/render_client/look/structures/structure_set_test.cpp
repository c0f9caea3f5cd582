// What viewers measure agrees with geometry, and with what the server measures.
#include "render_client/look/structures/structure_set.h"

#include <gtest/gtest.h>

#include <random>

#include "common/geometry/pose.h"
#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/scans/densify/distance_transform.h"
#include "haptic_server/surface/mesh/structure_mesher.h"
#include "tests/support/structure_shapes.h"
#include "tests/unit/render_client/look/structures/two_balls.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

using test::kFar;
using test::kFarRadius;
using test::kNear;
using test::kNearRadius;
using test::kWarning;
using test::twoBalls;

Pose at(const Vector3d& p) {
    Pose pose;
    pose.position = p;
    return pose;
}

std::vector<BurrBall> ballsOf(const Burr& burr) {
    std::vector<BurrBall> balls;
    for (const BurrProbe& probe : BurrProbes(burr)) balls.push_back({probe.center_T, probe.radius});
    return balls;
}

TEST(StructureSet, ClearanceIsTheGapOfTwoBalls) {
    const StructureSet structures = twoBalls();
    const std::vector<BurrBall> burr{{Vector3d(0, 1e-3, 0), 5e-4}};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-0.009, 0.009);
    int seen = 0;
    for (int n = 0; n < 500; ++n) {
        const Vector3d center = kNear + Vector3d(part(random), part(random), part(random));
        const double expected = (center - kNear).norm() - kNearRadius - 5e-4;
        const auto near = structures.clearances(burr, at(center - Vector3d(0, 1e-3, 0)));
        const auto of_it = std::ranges::find(near, 3u, &Clearance::structure);
        if (std::abs(expected - kWarning) > 2e-5) {
            EXPECT_EQ(of_it != near.end(), expected < kWarning);
        }
        if (of_it == near.end()) continue;
        EXPECT_NEAR(of_it->distance, expected, 1e-5);
        if (expected > 1e-4) {
            EXPECT_NEAR((of_it->structure_V - of_it->burr_V).norm(), expected, 1e-5);
            EXPECT_NEAR((of_it->burr_V - center).norm(), 5e-4, 1e-7);
        }
        ++seen;
    }
    EXPECT_GT(seen, 100);
}

TEST(StructureSet, TheNearestComesFirst) {
    const StructureSet structures = twoBalls();
    const std::vector<BurrBall> burr{{Vector3d::Zero(), 3.5e-3}};
    const auto near = structures.clearances(burr, at({0.018, 0.01, 0.01}));
    ASSERT_EQ(near.size(), 2u);
    EXPECT_EQ(near[0].structure, 3u);
    EXPECT_NEAR(near[0].distance, 0.5e-3, 1e-5);
    EXPECT_NEAR(near[1].distance, 0.5e-3, 1e-5);
    EXPECT_EQ(structures.clearances(burr, at({0.0195, 0.01, 0.01}))[0].structure, 7u);
    EXPECT_TRUE(structures.clearances(burr, at({0.1, 0.1, 0.1})).empty());
}

TEST(StructureSet, DeepInAStructureTheBurrIsInIt) {
    const auto near = twoBalls().clearances(std::vector<BurrBall>{{Vector3d::Zero(), 1e-4}},
                                            at(kNear + Vector3d(0, 0, 4e-4)));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_NEAR(near[0].distance, -3.7e-3, 2e-5);
    const auto nearest = twoBalls().nearest((kNear + Vector3d(0, 0, 4e-4)).cast<float>(), 1e-3f,
                                            [](uint32_t) { return true; });
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->distance, 0);
}

// The server measures to voxels, the viewer to the smooth surface of the same voxels.
void expectTheServersDistance(const Burr& burr) {
    const Vector3d spacing(4e-4, 4e-4, 5e-4), middle(0.0123, 0.0118, 0.0151);
    VolumeGeometry geometry;
    geometry.dims.setConstant(60);
    geometry.spacing = spacing;
    const VoxelVolume volume(geometry, 1000);
    const BoneProperties properties(volume, [&](const Eigen::Vector3i& v) {
        const Vector3d r = spacing.cwiseProduct(v.cast<double>()) - middle;
        const Vector3d along = Vector3d(1, 0.5, 0.3).normalized();
        const double tube = (r - std::clamp(r.dot(along), -0.007, 0.007) * along).norm() - 1.1e-3;
        return MaterialId(tube < 0 ? 1 : 0);
    });
    MaterialTable materials(2);
    materials[1].is_protected = true;
    const auto field = protectedDistance(properties, materials, spacing, kWarning + 3e-3);
    StructureSet structures;
    for (const NodeMesh& mesh : meshStructures(properties, materials, spacing))
        structures.set(mesh, kWarning);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> part(-1, 1);
    const auto somewhere = [&] { return Vector3d(part(random), part(random), part(random)); };
    int compared = 0;
    for (int n = 0; n < 600; ++n) {
        Pose X_VT = at(middle + 0.009 * somewhere());
        X_VT.rotation = expRotation(3 * somewhere());
        const NearestStructure server = nearestStructure(*field, BurrProbes(burr), X_VT);
        const auto viewer = structures.clearances(ballsOf(burr), X_VT);
        if (viewer.empty() || viewer[0].distance < 0) continue;
        EXPECT_EQ(server.material, 1);
        EXPECT_NEAR(viewer[0].distance, server.distance, spacing.maxCoeff());
        ++compared;
    }
    EXPECT_GT(compared, 100);
}

TEST(StructureSet, ABallsDistanceIsTheServersWithinAVoxel) {
    Burr burr;
    burr.radius = 1e-3;
    expectTheServersDistance(burr);
}

TEST(StructureSet, ACylindersDistanceIsTheServersWithinAVoxel) {
    Burr burr;
    burr.kind = BurrKind::kCylinder;
    burr.radius = 6e-4;
    burr.length = 4e-3;
    expectTheServersDistance(burr);
}

TEST(StructureSet, TheBurrComesFromTheSceneInfo) {
    topics::SceneInfo info;
    info.set_burr_radius_m(2e-3);
    ASSERT_EQ(burrBallsOf(info).size(), 1u);
    EXPECT_EQ(burrBallsOf(info)[0].radius, 2e-3);
    for (const float number : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f, 7.f, 0.f}) info.add_burr_balls_m(number);
    ASSERT_EQ(burrBallsOf(info).size(), 2u);
    EXPECT_EQ(burrBallsOf(info)[1].center_T, Vector3d(5, 6, 7));
    EXPECT_EQ(burrBallsOf(info)[1].radius, 0);
}

}  // namespace
}  // namespace bonemill
