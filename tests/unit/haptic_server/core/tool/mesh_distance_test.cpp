#include "haptic_server/scans/solid_mesh/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/unit/haptic_server/core/tool/mesh_test_support.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::cornersOf;

template <class Visit>
void forRandomPointsAround(const TriangleMesh& mesh, int count, Visit&& visit) {
    const Eigen::AlignedBox3d box = mesh.box();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> wide(-0.3, 1.3);
    for (int n = 0; n < count; ++n)
        visit(Vector3d(box.min() +
                       box.sizes().cwiseProduct(Vector3d(wide(random), wide(random), wide(random)))));
}

TEST(MeshDistance, BoxIsExact) {
    const Vector3d half(1e-3, 2e-3, 3e-3);
    const TriangleMesh mesh = closedMesh(cornersOf(test::boxSoup({-1, -2, -3}, {1, 2, 3})), "box.stl");
    const MeshDistance distance(mesh);
    forRandomPointsAround(mesh, 20000, [&](const Vector3d& p) {
        const Vector3d beyond = p.cwiseAbs() - half;
        const double expected = beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
        ASSERT_NEAR(distance.query(p).distance, expected, 1e-14) << p.transpose();
    });
}

TEST(MeshDistance, SphereLiesWithinItsFacets) {
    constexpr int kRings = 60;
    const double radius = 2e-3;
    const TriangleMesh mesh = closedMesh(
        cornersOf(test::ballSoup(kRings, {1, 0, -1}, [](const auto&) { return 2.0; })), "ball.stl");
    const MeshDistance distance(mesh);
    // No facet is wider than pi/kRings both ways, so none lies deeper than this below the sphere.
    const double half_diagonal = std::sqrt(2.0) * std::numbers::pi / kRings / 2;
    const double sagitta = radius * (1 - std::cos(half_diagonal));
    forRandomPointsAround(mesh, 5000, [&](const Vector3d& p) {
        const double sphere = (p - Vector3d(1e-3, 0, -1e-3)).norm() - radius;
        const double d = distance.query(p).distance;
        ASSERT_GE(d, sphere - 1e-9);
        ASSERT_LE(d, sphere + sagitta + 1e-9);
    });
}

void expectAsOracles(const TriangleMesh& mesh, int points) {
    const MeshDistance distance(mesh);
    std::mt19937 random(9);
    std::uniform_int_distribution<uint32_t> triangle(0, uint32_t(mesh.triangles.size() - 1));
    int inside = 0;
    forRandomPointsAround(mesh, points, [&](const Vector3d& p) {
        const bool is_inside = test::windingNumber(mesh, p) > 0.5;
        const double expected = (is_inside ? -1 : 1) * test::unsignedDistance(mesh, p);
        inside += is_inside;
        ASSERT_NEAR(distance.query(p).distance, expected, 1e-12) << p.transpose();
        ASSERT_NEAR(distance.query(p, triangle(random)).distance, expected, 1e-12)
            << "bad guess " << p.transpose();
    });
    EXPECT_GT(inside, points / 50);
    EXPECT_LT(inside, points / 2);
}

TEST(MeshDistance, ConcavePrism) {  // an L: fans from its inner corner
    const auto l_shape = test::prism({{1, 1}, {1, 3}, {0, 3}, {0, 0}, {3, 0}, {3, 1}}, -1, 1);
    expectAsOracles(closedMesh(cornersOf(l_shape), "l.stl"), 5000);
}

TEST(MeshDistance, SpikyBall) {  // sharp edges and vertices of every kind, where one face's normal misleads
    const auto radius = [](const Vector3d& d) {
        return 1.2 + 0.9 * std::sin(17 * d.x() + 3) * std::sin(19 * d.y()) * std::sin(13 * d.z() + 1);
    };
    expectAsOracles(closedMesh(cornersOf(test::ballSoup(14, {0, 0, 0}, radius)), "spiky.stl"), 4000);
}

TEST(MeshDistance, HollowBox) {
    test::TriangleSoup soup = test::boxSoup({-2, -2, -2}, {2, 2, 2});
    const test::TriangleSoup cavity = test::insideOut(test::boxSoup({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}));
    soup.insert(soup.end(), cavity.begin(), cavity.end());
    expectAsOracles(closedMesh(cornersOf(soup), "hollow.stl"), 4000);
}

TEST(MeshDistance, AtTheSurfaceItIsZero) {
    const TriangleMesh mesh = closedMesh(cornersOf(test::boxSoup({-1, -2, -3}, {1, 2, 3})), "box.stl");
    const MeshDistance distance(mesh);
    for (const Vector3d& vertex : mesh.vertices) EXPECT_EQ(distance.query(vertex).distance, 0);
    EXPECT_NEAR(distance.query({1e-3, 0, 0}).distance, 0, 1e-18);
}

}  // namespace
}  // namespace bonemill
