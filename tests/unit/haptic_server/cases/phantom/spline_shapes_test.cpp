#include "haptic_server/cases/phantom/spline_shapes.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using Eigen::Vector3d;

TEST(SplineTube, StraightOneIsACapsule) {
    const SplineTube tube({{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, 1.5);
    EXPECT_NEAR(tube.signedDistance({3, 2, 0}), 0.5, 1e-12);
    EXPECT_NEAR(tube.signedDistance({5.3, 0.6, 0.8}), -0.5, 1e-12);
    EXPECT_NEAR(tube.signedDistance({11, 4, 0}), 3.5, 1e-12);
    EXPECT_TRUE(tube.contains({9.4, 0, 0}));
    EXPECT_FALSE(tube.contains({9.6, 0, 0}));
    EXPECT_TRUE(
        tube.box().isApprox(Eigen::AlignedBox3d(Vector3d(-1.5, -1.5, -1.5), Vector3d(9.5, 1.5, 1.5))));
}

TEST(SplineTube, PassesThroughItsPointsAndBendsBetweenThem) {
    const std::vector<Vector3d> points{{0, 0, 0}, {2, 0, 0}, {4, 2, 0}, {4, 4, 1}};
    const SplineTube tube(points, 0.5);
    for (const Vector3d& p : points) EXPECT_NEAR(tube.signedDistance(p), -0.5, 1e-12);
    EXPECT_GT(tube.signedDistance({3, 1, 0}), -0.5 + 1e-3) << "the curve does not cut the corner straight";
    EXPECT_LT(tube.signedDistance({3, 1, 0}), 0);
}

TEST(SplineSheet, FollowsAPlaneExactly) {
    SplineSheet::Lattice lattice{{1, 2}, {2, 3}, {}};
    for (int row = 0; row < 3; ++row) {
        lattice.heights.emplace_back();
        for (int i = 0; i < 4; ++i)
            lattice.heights.back().push_back(0.5 * (1 + 2 * i) - 0.25 * (2 + 3 * row));
    }
    const SplineSheet sheet(lattice, 0.8);
    for (double x = 1; x <= 7; x += 0.37)
        for (double y = 2; y <= 8; y += 0.53) EXPECT_NEAR(sheet.heightAt(x, y), 0.5 * x - 0.25 * y, 1e-12);
    const double height = sheet.heightAt(4, 5);
    EXPECT_TRUE(sheet.contains({4, 5, height + 0.7}));
    EXPECT_FALSE(sheet.contains({4, 5, height + 0.9}));
    EXPECT_FALSE(sheet.contains({4, 5, height - 0.1}));
    EXPECT_FALSE(sheet.contains({0.9, 5, sheet.heightAt(1, 5) + 0.1}));
    EXPECT_FALSE(sheet.contains({4, 8.1, sheet.heightAt(4, 8) + 0.1}));
}

}  // namespace
}  // namespace bonemill
