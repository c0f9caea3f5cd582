#include "haptic_server/core/tool/sdf_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1e-3;
const Vector3d kCenter(0.1e-3, -0.2e-3, 0.05e-3);

double sphereDistance(const Vector3d& p) {
    return (p - kCenter).norm() - kRadius;
}

SdfGrid sphereGrid(double spacing) {
    const Eigen::Vector3i nodes = Eigen::Vector3i(26, 28, 24) * int(std::lround(0.125e-3 / spacing));
    const Vector3d origin(-1.5e-3, -1.8e-3, -1.4e-3);
    std::vector<float> values;
    for (int k = 0; k < nodes.z(); ++k)
        for (int j = 0; j < nodes.y(); ++j)
            for (int i = 0; i < nodes.x(); ++i)
                values.push_back(float(sphereDistance(origin + spacing * Vector3d(i, j, k))));
    return SdfGrid(nodes, spacing, origin, std::move(values));
}

template <class Visit>
void forRandomPoints(const Eigen::AlignedBox3d& box, int count, Visit&& visit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < count; ++n)
        visit(Vector3d(box.min() +
                       box.sizes().cwiseProduct(Vector3d(unit(random), unit(random), unit(random)))));
}

double worstError(const SdfGrid& grid, double& worst_over_bound) {
    double worst = 0;
    worst_over_bound = 0;
    forRandomPoints(grid.gridBox(), 20000, [&](const Vector3d& p) {
        const double cell_diagonal = std::sqrt(3.0) * grid.spacing();
        const double least_radius = (p - kCenter).norm() - cell_diagonal;
        if (least_radius < kRadius / 2) return;
        const double error = std::abs(double(grid.distance(p)) - sphereDistance(p));
        // Linear interpolation errs by h²/8 of the second derivative per axis; they sum up to 2/r for
        // a sphere.
        const double bound = grid.spacing() * grid.spacing() / (4 * least_radius) + 1e-9;
        worst = std::max(worst, error);
        worst_over_bound = std::max(worst_over_bound, error / bound);
    });
    return worst;
}

TEST(SdfGrid, IsExactAtNodes) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    for (int k = 0; k < grid.nodes().z(); ++k)
        for (int j = 0; j < grid.nodes().y(); ++j)
            for (int i = 0; i < grid.nodes().x(); ++i) {
                const Vector3d p = grid.nodePosition(i, j, k);
                ASSERT_NEAR(grid.distance(p), sphereDistance(p), 2e-10);
                ASSERT_EQ(grid.at(i, j, k), float(sphereDistance(p)));
            }
}

TEST(SdfGrid, ErrorBetweenNodesIsOfSecondOrder) {
    double coarse_over_bound = 0, fine_over_bound = 0;
    const double coarse = worstError(sphereGrid(0.125e-3), coarse_over_bound);
    const double fine = worstError(sphereGrid(0.0625e-3), fine_over_bound);
    EXPECT_LE(coarse_over_bound, 1);
    EXPECT_LE(fine_over_bound, 1);
    EXPECT_GT(coarse / fine, 3.2);
    EXPECT_LT(coarse / fine, 4.8);
}

TEST(SdfGrid, ContactLoopGetsTheSameDistance) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    Eigen::AlignedBox3d shrunk = grid.gridBox();  // at the very end single precision may fall outside
    shrunk.min().array() += 1e-9;
    shrunk.max().array() -= 1e-9;
    forRandomPoints(shrunk, 20000, [&](const Vector3d& p) {
        ASSERT_NEAR(grid.distanceAt(p.cast<float>()), grid.distance(p), 2e-9);
    });
}

TEST(SdfGrid, IsFarAwayOutside) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        for (const double bad : {nan, infinity, -infinity, grid.gridBox().min()[axis] - 1e-7,
                                 grid.gridBox().max()[axis] + 1e-7, 1e30, -1e30}) {
            Vector3d p = kCenter;
            p[axis] = bad;
            EXPECT_FALSE(grid.contains(p)) << p.transpose();
            EXPECT_EQ(grid.distance(p), SdfGrid::kOutsideDistance) << p.transpose();
            EXPECT_EQ(grid.distanceAt(p.cast<float>()), SdfGrid::kOutsideDistance) << p.transpose();
            EXPECT_EQ(grid.gradient(p), Vector3d(Vector3d::Zero())) << p.transpose();
        }
}

TEST(SdfGrid, ContainsItsCorners) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    const auto last = (grid.nodes().array() - 1).eval();
    EXPECT_TRUE(grid.contains(grid.gridBox().min()));
    EXPECT_TRUE(grid.contains(grid.gridBox().max()));
    EXPECT_NEAR(grid.distance(grid.gridBox().max()), grid.at(last.x(), last.y(), last.z()), 1e-9);
    EXPECT_EQ(grid.distance(grid.gridBox().min()), grid.at(0, 0, 0));
}

TEST(SdfGrid, GradientIsThatOfTheInterpolant) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> fraction(0.3, 0.7);
    std::uniform_int_distribution<int> node(0, 22);
    for (int n = 0; n < 5000; ++n) {
        const Vector3d p = grid.nodePosition(node(random), node(random), node(random)) +
                           grid.spacing() * Vector3d(fraction(random), fraction(random), fraction(random));
        // Along an axis the interpolant is a straight line within the cell: the step may be large.
        const double step = grid.spacing() / 4;
        Vector3d differences;
        for (int axis = 0; axis < 3; ++axis) {
            const Vector3d d = step * Vector3d::Unit(axis);
            differences[axis] = (double(grid.distance(p + d)) - double(grid.distance(p - d))) / (2 * step);
        }
        ASSERT_LT((grid.gradient(p) - differences).norm(), 1e-5) << p.transpose();
    }
}

TEST(SdfGrid, GradientPointsAwayFromTheSphere) {
    const SdfGrid grid = sphereGrid(0.0625e-3);
    forRandomPoints(grid.gridBox(), 5000, [&](const Vector3d& p) {
        const Vector3d radial = p - kCenter;
        if (radial.norm() < 0.5e-3) return;
        ASSERT_LT((grid.gradient(p) - radial.normalized()).norm(), 0.15) << p.transpose();
    });
}

TEST(SdfGrid, NothingIsInsideOutsideOfTheBox) {
    const SdfGrid grid = sphereGrid(0.125e-3);
    int inside = 0;
    forRandomPoints(grid.gridBox(), 200000, [&](const Vector3d& p) {
        if (grid.distance(p) >= 0) return;
        ++inside;
        ASSERT_TRUE(grid.box().contains(p)) << p.transpose();
    });
    EXPECT_GT(inside, 1000);
    const double slack = 1e-12;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(grid.box().min()[axis], kCenter[axis] - kRadius - grid.spacing() - slack);
        EXPECT_LE(grid.box().max()[axis], kCenter[axis] + kRadius + grid.spacing() + slack);
    }
}

TEST(SdfGrid, BoxEndsWithTheGrid) {
    const SdfGrid grid({2, 2, 2}, 1e-3, Vector3d::Zero(), std::vector<float>(8, -1e-3f));
    EXPECT_TRUE(grid.box().isApprox(grid.gridBox()));
    const SdfGrid air({2, 2, 2}, 1e-3, Vector3d::Zero(), std::vector<float>(8, 1e-3f));
    EXPECT_TRUE(air.box().isEmpty());
}

TEST(SdfGrid, RefusesWhatIsNoGrid) {
    const std::vector<float> eight(8, 1.0f);
    std::vector<float> with_nan = eight;
    with_nan[3] = std::numeric_limits<float>::quiet_NaN();
    const Vector3d zero = Vector3d::Zero();
    EXPECT_THROW(SdfGrid({1, 2, 4}, 1e-3, zero, eight), std::invalid_argument);
    EXPECT_THROW(SdfGrid({2, 2, 3}, 1e-3, zero, eight), std::invalid_argument);
    EXPECT_THROW(SdfGrid({2, 2, 2}, 0, zero, eight), std::invalid_argument);
    EXPECT_THROW(SdfGrid({2, 2, 2}, std::nan(""), zero, eight), std::invalid_argument);
    EXPECT_THROW(SdfGrid({2, 2, 2}, 1e-3, Vector3d(0, std::nan(""), 0), eight), std::invalid_argument);
    EXPECT_THROW(SdfGrid({2, 2, 2}, 1e-3, zero, with_nan), std::invalid_argument);
}

}  // namespace
}  // namespace bonemill
