#include "haptic_server/surface/mesh/surroundings_mesher.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/joined_surface.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 1e-3, kFine = 0.3e-3, kRadius = 30.3e-3;
constexpr uint32_t kFirstLeaf = 100;
const Vector3d kBallAt = Vector3d::Constant(35.2e-3);  // S
const Pose kX_VS{Vector3d(-53.1e-3, -23e-3, -22.7e-3), Eigen::Quaterniond::Identity()};
const Eigen::Vector3i kRegion(50, 80, 80);  // voxels

Density ballAt(const Vector3d& p_S) {
    const double d = (p_S - kBallAt).norm() - kRadius;
    return Density(std::clamp(32768 - 15000 * d / kVoxel, 0.0, 65535.0));
}

// A ball of bone over several nodes; the part of it around its +x pole is milled.
Surroundings ballWithoutPole() {
    VoxelVolume scan(test::boxGeometry(Eigen::Vector3i::Constant(70), Vector3d::Constant(kVoxel)), 32768);
    scan.fill([](int i, int j, int k) { return ballAt(kVoxel * Vector3d(i, j, k)); });
    const auto fine = [](const Eigen::Vector3i& v) {
        return ballAt(kX_VS.inverse() * Vector3d(kFine * v.cast<double>()));
    };
    VoxelVolume region(test::boxGeometry(kRegion, Vector3d::Constant(kFine)), 32768);
    region.fill([&](int i, int j, int k) { return fine({i, j, k}); });
    return {std::move(scan), kX_VS, {}, RegionRim(region, fine)};
}

std::vector<NodeMesh> meshed(const Surroundings& surroundings) {
    std::vector<NodeMesh> meshes;
    meshSurroundings(surroundings, kFirstLeaf, {}, [&](NodeMesh&& mesh) {
        meshes.push_back(std::move(mesh));
        return true;
    });
    return meshes;
}

TEST(SurroundingsMesher, ShowsTheBoneWhereItLies) {
    const Surroundings ball = ballWithoutPole();
    for (const NodeMesh& mesh : meshed(ball)) {
        EXPECT_GE(mesh.leaf, kFirstLeaf);
        EXPECT_LT(mesh.leaf, kFirstLeaf + surroundingsLeafCount(ball));
        std::set<uint32_t> used(mesh.indices.begin(), mesh.indices.end());
        EXPECT_EQ(used.size(), mesh.vertices.size()) << "no vertex is sent for nothing";
        for (const uint32_t index : mesh.indices)
            ASSERT_NEAR((test::vertexPlace(mesh, index) - kX_VS * kBallAt).norm(), kRadius, 0.1 * kVoxel);
    }
}

TEST(SurroundingsMesher, LeavesTheMilledPartOut) {
    const Surroundings ball = ballWithoutPole();
    double area = 0;
    const Eigen::AlignedBox3d inside(Vector3d::Zero(), kFine * kRegion.cast<double>());
    for (const NodeMesh& mesh : meshed(ball))
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vector3d a = test::vertexPlace(mesh, mesh.indices[i]),
                           b = test::vertexPlace(mesh, mesh.indices[i + 1]),
                           c = test::vertexPlace(mesh, mesh.indices[i + 2]);
            EXPECT_FALSE(inside.contains((a + b + c) / 3));
            area += (b - a).cross(c - a).norm() / 2;
        }
    const double whole = 4 * M_PI * kRadius * kRadius;
    EXPECT_LT(area, 0.97 * whole);
    EXPECT_GT(area, 0.90 * whole);
}

// Every edge belongs to two triangles, or lies a voxel outside the region: no crack between nodes.
TEST(SurroundingsMesher, HasNoCracks) {
    const std::vector<NodeMesh> meshes = meshed(ballWithoutPole());
    const test::JoinedSurface surface(meshes);
    const Vector3d low = Vector3d::Constant(-kFine), high = kFine * kRegion.cast<double>();
    for (const Vector3d& p : surface.openPlaces())
        ASSERT_NEAR((low - p).cwiseMax(p - high).maxCoeff(), 0, 1e-6) << p.transpose();
    size_t triangles = 0;
    for (const NodeMesh& mesh : meshes) triangles += mesh.indices.size() / 3;
    EXPECT_LT(triangles, 14000u) << "a ball of that size has some 16000 without simplification";
}

TEST(SurroundingsMesher, EndsWhenItIsTold) {
    const Surroundings ball = ballWithoutPole();
    int meshes = 0;
    meshSurroundings(ball, kFirstLeaf, {}, [&](NodeMesh&&) { return ++meshes < 2; });
    EXPECT_EQ(meshes, 2);
}

}  // namespace
}  // namespace bonemill
