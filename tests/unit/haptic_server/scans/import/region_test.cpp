#include "haptic_server/scans/densify/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

constexpr double kMm = 1e-3;

// A mastoid's: 1 x 1 x 1.5 mm, turned and moved in W.
VolumeGeometry coarseGrid() {
    VolumeGeometry geometry;
    geometry.dims = {40, 36, 30};
    geometry.spacing = Eigen::Vector3d(1, 1, 1.5) * kMm;
    geometry.X_WV.position = Eigen::Vector3d(0.1, -0.2, 0.05);
    geometry.X_WV.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized());
    return geometry;
}

Eigen::AlignedBox3d boxInMiddle(const VolumeGeometry& grid, double half) {
    const Eigen::Vector3d middle = placeOfVoxel(grid, grid.dims / 2);
    return {middle - Eigen::Vector3d::Constant(half), middle + Eigen::Vector3d::Constant(half)};
}

TEST(Region, HasCubesThatCoverTheBoxWithinTheScan) {
    const VolumeGeometry scan = coarseGrid();
    const Eigen::AlignedBox3d box = boxInMiddle(scan, 5 * kMm);
    const VolumeGeometry region = regionGeometry(scan, box, 0.25 * kMm);
    EXPECT_TRUE(region.spacing.isConstant(0.25 * kMm));
    EXPECT_TRUE(region.X_WV.rotation.isApprox(scan.X_WV.rotation));
    const Eigen::Vector3d end =
        region.spacing.cwiseProduct((region.dims.array() - 1).matrix().cast<double>());
    const Eigen::AlignedBox3d covered(Eigen::Vector3d::Constant(-1e-9),
                                      end + Eigen::Vector3d::Constant(0.25 * kMm));
    for (int corner = 0; corner < 8; ++corner)
        EXPECT_TRUE(
            covered.contains(region.X_WV.inverse() * box.corner(Eigen::AlignedBox3d::CornerType(corner))));
}

TEST(Region, EndsWithTheScan) {
    const VolumeGeometry scan = coarseGrid();
    const VolumeGeometry region = regionGeometry(scan, boxInMiddle(scan, 1), 0.5 * kMm);
    EXPECT_TRUE(region.X_WV.position.isApprox(scan.X_WV.position));
    EXPECT_EQ(region.dims, Eigen::Vector3i(79, 71, 88));
}

TEST(Region, IsNothingBesideTheScan) {
    const Eigen::AlignedBox3d far(Eigen::Vector3d::Constant(5), Eigen::Vector3d::Constant(6));
    EXPECT_EQ(regionGeometry(coarseGrid(), far, 0.25 * kMm).voxelCount(), 0u);
}

// A linear field comes back everywhere that the mirrored ends of the scan are far from.
TEST(Region, ValuesLieWhereTheScanSaysToAMicrometre) {
    const VolumeGeometry grid = coarseGrid();
    const Eigen::Vector3d slope(2e4, -3e4, 5e4);  // per m: 20 per mm and more
    const RawVolume scan = scanOf(grid, [&](const Eigen::Vector3d& p) { return 700.25 + slope.dot(p); });
    const VolumeGeometry region = regionGeometry(grid, boxInMiddle(grid, 4 * kMm), 0.3 * kMm);
    const RawVolume fine = resampleRegion(scan, region, scan.values.range());
    ASSERT_EQ(fine.values.size(), region.voxelCount());
    forEachIndex({Eigen::Vector3i::Zero(), region.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        ASSERT_NEAR(double(fine.values[indexOf(region, v)]), 700.25 + slope.dot(placeOfVoxel(region, v)),
                    0.02)
            << v.transpose();
    });
}

TEST(Region, GoesThroughTheScansOwnVoxels) {
    VolumeGeometry grid = coarseGrid();
    grid.spacing.setConstant(kMm);
    grid.X_WV = {};
    const RawVolume scan = scanOf(grid, [](const Eigen::Vector3d& p) {
        return std::round(500 + 400 * std::sin(p.x() / kMm) * std::cos(1.7 * p.y() / kMm) +
                          90 * std::sin(2.1 * p.z() / kMm));
    });
    const Eigen::AlignedBox3d box(Eigen::Vector3d(7, 8, 9) * kMm, Eigen::Vector3d(15, 16, 17) * kMm);
    const RawVolume fine = resampleRegion(scan, regionGeometry(grid, box, 0.5 * kMm), scan.values.range());
    EXPECT_TRUE(fine.values.range().are_integers) << "whole numbers stay whole";
    for (int k = 0; k <= 8; ++k)
        for (int j = 0; j <= 8; ++j)
            for (int i = 0; i <= 8; ++i)
                EXPECT_EQ(fine.values[indexOf(fine.geometry, 2 * Eigen::Vector3i(i, j, k))],
                          scan.values[indexOf(grid, Eigen::Vector3i(7 + i, 8 + j, 9 + k))]);
}

// No value beyond those scanned: a step rings by a tenth, and would leave the window.
TEST(Region, StaysWithinTheScansRange) {
    const VolumeGeometry grid = coarseGrid();
    const RawVolume scan = scanOf(grid, [&](const Eigen::Vector3d& p) {
        return (grid.X_WV.inverse() * p).x() > 20 * kMm ? 3000.0 : -1000.0;
    });
    const RawVolume fine = resampleRegion(scan, regionGeometry(grid, boxInMiddle(grid, 6 * kMm), 0.25 * kMm),
                                          scan.values.range());
    EXPECT_GE(fine.values.range().low, -1000);
    EXPECT_LE(fine.values.range().high, 3000);
}

// Blurring a wave of this length takes 1 - exp(-(blur k)² / 2) of it; the first order gives most of that
// back.
// Padding of -3024 beside soft tissue would ring to 370 HU.
TEST(Region, MakesNoBoneOfPaddingBesideTissue) {
    const VolumeGeometry grid = coarseGrid();
    const RawVolume scan = scanOf(grid, [&](const Eigen::Vector3d& p) {
        return (grid.X_WV.inverse() * p).x() > 20.5 * kMm ? 40.0 : -3024.0;
    });
    ValueRange band = scan.values.range();
    const VolumeGeometry region = regionGeometry(grid, boxInMiddle(grid, 6 * kMm), 0.25 * kMm);
    const auto highest = [&] {
        const RawVolume fine = resampleRegion(scan, region, {band.low, 3071, true, 0});
        return fine.values.range().high;
    };
    EXPECT_GT(highest(), 300);
    band.low = -1000;
    EXPECT_LT(highest(), 200);
}

TEST(Region, TakesABlurBackToFirstOrder) {
    VolumeGeometry grid = coarseGrid();
    grid.X_WV = {};
    const double blur = 0.5 * kMm, k = 2 * M_PI / (8 * kMm), left = std::exp(-blur * blur * k * k / 2);
    const RawVolume scan =
        scanOf(grid, [&](const Eigen::Vector3d& p) { return 1000.5 + 400.25 * left * std::sin(k * p.x()); });
    const VolumeGeometry region = regionGeometry(grid, boxInMiddle(grid, 4 * kMm), 0.25 * kMm);
    const RawVolume blurred = resampleRegion(scan, region, scan.values.range()),
                    sharp = resampleRegion(scan, region, scan.values.range(), blur);
    double worst_blurred = 0, worst_sharp = 0;
    forEachIndex({Eigen::Vector3i::Zero(), region.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double truth = 1000.5 + 400.25 * std::sin(k * placeOfVoxel(region, v).x());
        worst_blurred = std::max(worst_blurred, std::abs(double(blurred.values[indexOf(region, v)]) - truth));
        worst_sharp = std::max(worst_sharp, std::abs(double(sharp.values[indexOf(region, v)]) - truth));
    });
    EXPECT_NEAR(worst_blurred, 400 * (1 - left), 4);
    EXPECT_LT(worst_sharp, 0.15 * worst_blurred);
}

TEST(Region, TakesWhatIsNotFiniteForTheEndsOfTheRange) {
    VolumeGeometry grid = coarseGrid();
    const RawVolume scan = scanOf(grid, [&](const Eigen::Vector3d& p) {
        const Eigen::Vector3d v = (grid.X_WV.inverse() * p).cwiseQuotient(grid.spacing);
        if (v.isApprox(Eigen::Vector3d(20, 18, 15), 1e-6)) return std::numeric_limits<double>::quiet_NaN();
        return v.x() < 10 ? -1000.0 : 400.5;
    });
    const RawVolume fine = resampleRegion(scan, regionGeometry(grid, boxInMiddle(grid, 3 * kMm), 0.5 * kMm),
                                          scan.values.range());
    EXPECT_EQ(fine.values.range().non_finite, 0u);
    EXPECT_LT(fine.values.range().low, -500) << "the hole";
}

}  // namespace
}  // namespace bonemill
