#include "haptic_server/surface/mesh/surroundings_mesher.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 1e-3, kRadius = 30.3e-3;
constexpr uint32_t kFirstLeaf = 100;
const Vector3d kBallAt = Vector3d::Constant(35.2e-3);  // S
const Pose kX_VS{Vector3d(-20e-3, 5e-3, 1e-3), Eigen::Quaterniond::Identity()};

// A ball of bone over several nodes; the part of it around its +x pole is milled.
Surroundings ballWithoutPole() {
    VoxelVolume volume(test::boxGeometry(Eigen::Vector3i::Constant(70), Vector3d::Constant(kVoxel)), 32768);
    for (int k = 0; k < 70; ++k)
        for (int j = 0; j < 70; ++j)
            for (int i = 0; i < 70; ++i) {
                const double d = ((kVoxel * Vector3d(i, j, k)) - kBallAt).norm() - kRadius;
                volume.set(i, j, k, Density(std::clamp(32768 - 15000 * d / kVoxel, 0.0, 65535.0)));
            }
    const Vector3d low = kX_VS * Vector3d(kBallAt + Vector3d(20e-3, -12e-3, -12e-3));
    return {std::move(volume), kX_VS, {low, low + Vector3d(20e-3, 24e-3, 24e-3)}, {}};
}

std::vector<NodeMesh> meshed(const Surroundings& surroundings) {
    std::vector<NodeMesh> meshes;
    meshSurroundings(surroundings, kFirstLeaf, {}, [&](NodeMesh&& mesh) {
        meshes.push_back(std::move(mesh));
        return true;
    });
    return meshes;
}

Vector3d placeOf(const NodeMesh& mesh, uint32_t index) {
    const PackedVertex& v = mesh.vertices[index];
    return (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
}

TEST(SurroundingsMesher, ShowsTheBoneWhereItLies) {
    const Surroundings ball = ballWithoutPole();
    for (const NodeMesh& mesh : meshed(ball)) {
        EXPECT_GE(mesh.leaf, kFirstLeaf);
        EXPECT_LT(mesh.leaf, kFirstLeaf + surroundingsLeafCount(ball.volume.geometry()));
        std::set<uint32_t> used(mesh.indices.begin(), mesh.indices.end());
        EXPECT_EQ(used.size(), mesh.vertices.size()) << "no vertex is sent for nothing";
        for (const uint32_t index : mesh.indices)
            ASSERT_NEAR((placeOf(mesh, index) - kX_VS * kBallAt).norm(), kRadius, 0.1 * kVoxel);
    }
}

TEST(SurroundingsMesher, LeavesTheMilledPartOut) {
    const Surroundings ball = ballWithoutPole();
    double area = 0;
    const Vector3d rim = Vector3d::Constant(1.5 * kVoxel);  // of triangles that reach out
    const Eigen::AlignedBox3d inside(ball.milled.min() + rim, ball.milled.max() - rim);
    for (const NodeMesh& mesh : meshed(ball))
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vector3d a = placeOf(mesh, mesh.indices[i]), b = placeOf(mesh, mesh.indices[i + 1]),
                           c = placeOf(mesh, mesh.indices[i + 2]);
            EXPECT_FALSE(inside.contains((a + b + c) / 3));
            area += (b - a).cross(c - a).norm() / 2;
        }
    const double whole = 4 * M_PI * kRadius * kRadius;
    EXPECT_LT(area, 0.97 * whole);
    EXPECT_GT(area, 0.90 * whole);
}

// Every edge belongs to two triangles, or lies at the milled part: no crack between nodes.
TEST(SurroundingsMesher, HasNoCracks) {
    const Surroundings ball = ballWithoutPole();
    using Point = std::array<int64_t, 3>;
    std::map<std::pair<Point, Point>, int> edges;
    size_t triangles = 0;
    for (const NodeMesh& mesh : meshed(ball))
        for (size_t i = 0; i < mesh.indices.size(); ++i) {
            triangles += i % 3 == 0;
            Point ends[2];
            for (size_t end = 0; end < 2; ++end) {
                const Vector3d p = placeOf(mesh, mesh.indices[i - i % 3 + (i + end) % 3]) / 1e-7;
                ends[end] = {std::llround(p.x()), std::llround(p.y()), std::llround(p.z())};
            }
            ++edges[std::minmax(ends[0], ends[1])];
        }
    const Eigen::AlignedBox3d near(ball.milled.min() - Vector3d::Constant(1.5 * kVoxel),
                                   ball.milled.max() + Vector3d::Constant(1.5 * kVoxel));
    for (const auto& [edge, count] : edges) {
        const Vector3d p =
            1e-7 * Vector3d(double(edge.first[0]), double(edge.first[1]), double(edge.first[2]));
        ASSERT_TRUE(count == 2 || near.contains(p)) << p.transpose();
    }
    EXPECT_LT(triangles, 12000u) << "a ball of that size has some 16000 without simplification";
}

TEST(SurroundingsMesher, EndsWhenItIsTold) {
    const Surroundings ball = ballWithoutPole();
    int meshes = 0;
    meshSurroundings(ball, kFirstLeaf, {}, [&](NodeMesh&&) { return ++meshes < 2; });
    EXPECT_EQ(meshes, 2);
}

}  // namespace
}  // namespace bonemill
