// Walls as a scanner sees them: the mean over each voxel of what is in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "haptic_server/scans/find_bone/propose_iso.h"

namespace bonemill {
namespace {

constexpr double kWallIso = 300, kSoftHu = 40, kBoneHu = 1600;

// A wall across x, `thickness` voxels from `begin` on, and a block of bone that says how dense bone is.
RawVolume wallOf(double begin, double thickness, double noise = 0) {
    RawVolume scan;
    scan.geometry.dims = {30, 12, 12};
    scan.geometry.spacing.setConstant(1e-3);
    std::mt19937 random(3);
    std::normal_distribution<double> grain(0, noise > 0 ? noise : 1);
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), scan.geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double share =
            std::clamp(std::min(v.x() + 0.5, begin + thickness) - std::max(v.x() - 0.5, begin), 0.0, 1.0);
        const double value = v.x() >= 24 ? kBoneHu : kSoftHu + share * (kBoneHu - kSoftHu);
        values.push_back(float(value + (noise > 0 ? grain(random) : 0)));
    });
    scan.values.append(std::span<const float>(values));
    return scan;
}

IndexBox allOf(const RawVolume& scan) {
    return {Eigen::Vector3i::Zero(), scan.geometry.dims.array() - 1};
}

TEST(ThinWalls, BelowTheIsoValueAreFoundWithTheirThickness) {
    for (const double thickness : {0.1, 0.14, 0.16}) {  // whole in one voxel: 40 + 0.16 * 1560 < 300
        const RawVolume scan = wallOf(10 - thickness / 2, thickness);
        const ThinWalls walls = findThinWalls(scan, allOf(scan), kWallIso);
        EXPECT_EQ(walls.voxels, 12u * 12u);
        EXPECT_NEAR(walls.median_thickness, thickness * 1e-3, 0.02e-3);
    }
}

TEST(ThinWalls, OnTwoVoxelsAreFoundOnOneOfThem) {
    const RawVolume scan = wallOf(10.5 - 0.16, 0.3);  // 0.16 of it in one voxel, 0.14 in the next
    const ThinWalls walls = findThinWalls(scan, allOf(scan), kWallIso);
    EXPECT_EQ(walls.voxels, 12u * 12u);
    EXPECT_NEAR(walls.median_thickness, 0.3e-3, 0.03e-3);
}

TEST(ThinWalls, ThatBecomeBoneAreNone) {
    const RawVolume scan = wallOf(9.5, 1);
    EXPECT_EQ(findThinWalls(scan, allOf(scan), kWallIso).voxels, 0u);
}

TEST(ThinWalls, AreNotSeenInTheNoiseOfSoftTissue) {
    const RawVolume scan = wallOf(0, 0, 25);
    EXPECT_LT(double(findThinWalls(scan, allOf(scan), kWallIso).voxels), 0.001 * double(scan.values.size()));
}

TEST(ThinWalls, AreLookedForInTheBoxOnly) {
    const RawVolume scan = wallOf(9.93, 0.14);
    EXPECT_EQ(findThinWalls(scan, {{0, 0, 0}, {9, 11, 11}}, kWallIso).voxels, 0u);
    EXPECT_EQ(findThinWalls(scan, {{10, 2, 3}, {10, 5, 4}}, kWallIso).voxels, 8u);
}

}  // namespace
}  // namespace bonemill
