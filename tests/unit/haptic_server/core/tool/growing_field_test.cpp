#include "haptic_server/core/tool/growing_field.h"

#include <gtest/gtest.h>

#include "haptic_server/core/tool/shape_field.h"

namespace bonemill {
namespace {

// A sphere that is 0.6 mm smaller is a sphere, with the same gradients.
TEST(GrowingField, ASmallerSphereIsTheSphereOfThatRadius) {
    const ShapeField large({SphereShape{{0, 0, 0}, 1.5e-3}}), small({SphereShape{{0, 0, 0}, 0.9e-3}});
    GrowingField field;
    field.setWhole(large);
    field.setOffset(0.6e-3);
    PointBatch<float> points;
    for (int n = 0; n < 40; ++n) {
        points.x[n] = float(1e-4 * n), points.y[n] = float(5e-5 * (n % 7)), points.z[n] = 1e-5f;
        ++points.count;
    }
    SampleBatch<float> grown, expected;
    float distances[PointBatch<float>::kCapacity];
    field.sample(points, grown);
    field.distances(points, distances);
    small.sample(points, expected);
    for (int n = 0; n < points.count; ++n) {
        EXPECT_NEAR(grown.distance[n], expected.distance[n], 1e-9);
        EXPECT_NEAR(distances[n], expected.distance[n], 1e-9);
        EXPECT_NEAR(grown.gx[n], expected.gx[n], 1e-5);
    }
    const Eigen::Vector3d at(2e-3, 1e-3, -1e-3);
    EXPECT_NEAR(field.sample(at).distance, small.sample(at).distance, 1e-12);
    EXPECT_LE(field.distanceBound(at), small.sample(at).distance + 1e-12);
    EXPECT_NEAR(field.thinnestRadius(), 0.9e-3, 1e-12);
}

TEST(GrowingField, AWholeOneIsTheToolAndAVanishedOneKeepsARadius) {
    const ShapeField tool({CapsuleShape{{0, 0, 0}, {0, 0.01, 0}, 1e-3}});
    GrowingField field;
    field.setWhole(tool);
    field.setOffset(5e-3);
    EXPECT_GT(field.sample(Eigen::Vector3d(0, 1e-3, 0)).distance, 0);
    EXPECT_GT(field.thinnestRadius(), 0);
    EXPECT_TRUE(field.box().isApprox(tool.box()));
    field.setOffset(-1);
    EXPECT_EQ(field.offset(), 0);
    EXPECT_EQ(field.thinnestRadius(), tool.thinnestRadius());
    EXPECT_EQ(field.reach(), tool.reach());
}

}  // namespace
}  // namespace bonemill
