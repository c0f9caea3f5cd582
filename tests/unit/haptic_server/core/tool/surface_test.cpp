#include "haptic_server/scene/tool_build/surface.h"

#include <gtest/gtest.h>

#include <set>

#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/unit/haptic_server/core/tool/mesh_test_support.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

const Vector3d kFrom(0.4e-3, -0.3e-3, 0.7e-3), kTo(1.5e-3, 2.2e-3, -0.4e-3);
constexpr double kPi = std::numbers::pi;

double volumeOf(const TriangleSurface& surface) {
    double volume = 0;
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const auto p = [&](size_t c) {
            return Vector3d(surface.positions[surface.indices[i + c]].cast<double>());
        };
        volume += p(0).dot(p(1).cross(p(2))) / 6;
    }
    return volume;
}

void expectSoundSurface(const TriangleSurface& surface) {
    ASSERT_EQ(surface.positions.size(), surface.normals.size());
    ASSERT_EQ(surface.indices.size() % 3, 0u);
    ASSERT_FALSE(surface.indices.empty());
    for (const Eigen::Vector3f& n : surface.normals) ASSERT_NEAR(n.norm(), 1, 1e-5);
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        for (size_t c = 0; c < 3; ++c) ASSERT_LT(surface.indices[i + c], surface.positions.size());
        const auto p = [&](size_t c) { return surface.positions[surface.indices[i + c]]; };
        const Eigen::Vector3f face = (p(1) - p(0)).cross(p(2) - p(0)).stableNormalized();
        for (size_t c = 0; c < 3; ++c) ASSERT_GT(face.dot(surface.normals[surface.indices[i + c]]), 0.7f);
    }
}

// The surface lies on the shape, has its normals (away from edges, where the distance has a gradient), and is
// of its volume.
void expectSurfaceOf(const ToolShape& shape, double volume) {
    const TriangleSurface surface = surfaceOf(std::vector<ToolShape>{shape});
    expectSoundSurface(surface);
    for (size_t v = 0; v < surface.positions.size(); ++v) {
        const Vector3d p = surface.positions[v].cast<double>(), n = surface.normals[v].cast<double>();
        ASSERT_NEAR(signedDistance(shape, p), 0, 1e-9);
        ASSERT_GE(signedDistance(shape, p + 1e-5 * n), 0.7e-5);
    }
    EXPECT_NEAR(volumeOf(surface) / volume, 1, 0.01);
    EXPECT_LT(volumeOf(surface), volume);
}

TEST(Surface, OfEachShape) {
    const double r = 0.8e-3, length = (kTo - kFrom).norm();
    expectSurfaceOf(SphereShape{kFrom, r}, 4 * kPi / 3 * r * r * r);
    expectSurfaceOf(CapsuleShape{kFrom, kTo, r}, 4 * kPi / 3 * r * r * r + kPi * r * r * length);
    expectSurfaceOf(CylinderShape{kFrom, kTo, r}, kPi * r * r * length);
    const double s = 0.3e-3;
    expectSurfaceOf(ConeShape{kFrom, kTo, r, s}, kPi / 3 * length * (r * r + r * s + s * s));
    expectSurfaceOf(ConeShape{kFrom, kTo, s, r}, kPi / 3 * length * (r * r + r * s + s * s));
    expectSurfaceOf(ConeShape{kFrom, kTo, 0, r}, kPi / 3 * length * r * r);
}

TEST(Surface, OfTheDefaultTool) {
    const TriangleSurface surface = toolSurface({});
    expectSoundSurface(surface);
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : surface.positions) box.extend(p);
    EXPECT_NEAR(box.min().y(), -1e-3f, 1e-8f);
    EXPECT_NEAR(box.max().x(), 1e-3f, 1e-8f);
    EXPECT_GT(box.max().y(), float(buildTool({}).model.grid().gridBox().max().y()));
}

TEST(Surface, OfABoxKeepsSharpEdges) {
    const auto soup = test::boxSoup({-1, -2, -3}, {1, 2, 3});
    const TriangleSurface surface = surfaceOf(closedMesh(test::cornersOf(soup), "box.stl"));
    expectSoundSurface(surface);
    EXPECT_EQ(surface.positions.size(), 24u);
    for (const Eigen::Vector3f& n : surface.normals) EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1, 1e-6);
    EXPECT_NEAR(volumeOf(surface), 48e-9, 1e-14);
}

TEST(Surface, OfABallIsSmooth) {
    const auto soup = test::ballSoup(30, {0, 0, 0}, [](const auto&) { return 2.0; });
    const TriangleMesh mesh = closedMesh(test::cornersOf(soup), "ball.stl");
    const TriangleSurface surface = surfaceOf(mesh);
    expectSoundSurface(surface);
    EXPECT_EQ(surface.positions.size(), mesh.vertices.size());
    for (size_t v = 0; v < surface.positions.size(); ++v)
        ASSERT_GT(surface.normals[v].dot(surface.positions[v].normalized()), 0.998f);
}

}  // namespace
}  // namespace bonemill
