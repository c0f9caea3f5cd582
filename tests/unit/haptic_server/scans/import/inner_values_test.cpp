// Bone is made of what lies half a scan voxel under its surface.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/scans/densify/voxel_materials.h"

namespace bonemill {
namespace {

constexpr double kBoneValue = 300;
using ValueAt = std::function<float(const Eigen::Vector3i&)>;

RawVolume regionOf(const ValueAt& value, const Eigen::Vector3i& dims) {
    RawVolume region;
    region.geometry.dims = dims;
    region.geometry.spacing.setConstant(0.25e-3);
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), dims.array() - 1},
                 [&](const Eigen::Vector3i& v) { values.push_back(value(v)); });
    region.values.append(std::move(values));
    return region;
}

float at(const RawValues& values, const Eigen::Vector3i& dims, const Eigen::Vector3i& v) {
    return values[size_t(v.x() + dims.x() * (v.y() + dims.y() * v.z()))];
}

// A ramp of 100 per voxel along an axis: 2 voxels are half of the scan's 1 mm, 3 of its 1.5 mm.
TEST(InnerValues, AreThoseHalfAScanVoxelDeeper) {
    const Eigen::Vector3i dims(16, 12, 14);
    for (int axis = 0; axis < 3; ++axis) {
        const auto ramp = [&](const Eigen::Vector3i& v) { return float(100 * v[axis] - 200.5); };
        const RawVolume region = regionOf(ramp, dims);
        const RawValues inner = innerValues(region, kBoneValue, Eigen::Vector3d(1e-3, 1e-3, 1.5e-3));
        const int reach = axis == 2 ? 3 : 2;
        forEachIndex({Eigen::Vector3i::Zero(), dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            Eigen::Vector3i deeper = v;
            deeper[axis] = std::min(v[axis] + reach, dims[axis] - 1);
            EXPECT_EQ(at(inner, dims, v), ramp(ramp(v) >= kBoneValue ? deeper : v)) << v.transpose();
        });
    }
}

TEST(InnerValues, OfAThinWallAreItsHighest) {
    const Eigen::Vector3i dims(20, 5, 5);
    const auto wall = [](const Eigen::Vector3i& v) { return 900.0f - 200 * float(std::abs(v.x() - 10)); };
    const RawValues inner = innerValues(regionOf(wall, dims), kBoneValue, Eigen::Vector3d::Constant(2e-3));
    for (int x = 0; x < 20; ++x)
        EXPECT_EQ(at(inner, dims, {x, 2, 2}), x >= 7 && x <= 13 ? 900 : wall({x, 2, 2}));
}

TEST(InnerValues, TakeNothingFromWhatIsNoNumber) {
    const Eigen::Vector3i dims(8, 1, 1);
    const auto value = [](const Eigen::Vector3i& v) {
        return v.x() == 4 ? std::numeric_limits<float>::quiet_NaN() : 400.25f + float(v.x());
    };
    const RawValues inner = innerValues(regionOf(value, dims), kBoneValue, Eigen::Vector3d::Constant(1e-3));
    EXPECT_EQ(at(inner, dims, {3, 0, 0}), 405.25f);
    EXPECT_TRUE(std::isnan(at(inner, dims, {4, 0, 0})));
}

TEST(InnerValues, OfVoxelsNoFinerThanTheScansAreTheirOwn) {
    const Eigen::Vector3i dims(9, 9, 9);
    const auto value = [](const Eigen::Vector3i& v) {
        return float((v.x() * 37 + v.y() * 11 + v.z() * 5) % 900);
    };
    const RawVolume region = regionOf(value, dims);
    for (const double scan : {0.2e-3, 0.25e-3})
        EXPECT_TRUE(innerValues(region, kBoneValue, Eigen::Vector3d::Constant(scan)) == region.values)
            << scan;
}

// 0.64 mm of scan are 2.56 voxels: half of them is one voxel, and not two.
TEST(InnerValues, ReachNoFartherThanHalfAScanVoxel) {
    const Eigen::Vector3i dims(9, 1, 1);
    const auto ramp = [](const Eigen::Vector3i& v) { return 400.5f + 100 * float(v.x()); };
    const RawValues inner = innerValues(regionOf(ramp, dims), kBoneValue, Eigen::Vector3d::Constant(0.64e-3));
    for (int x = 0; x < 8; ++x) EXPECT_EQ(at(inner, dims, {x, 0, 0}), ramp({x + 1, 0, 0}));
}

// Air up to 2, a hard shell from 5 on, a soft core from 9 on; two voxels are half of a scan voxel.
TEST(SurfaceValues, AreTheInnerOnesAtTheSurfaceAndTheirOwnBelow) {
    const Eigen::Vector3i dims(16, 3, 3);
    const std::vector<float> profile = {-900, -900, -100, 310,   600,   1200,  1200, 1200.5,
                                        900,  500,  500,  500.5, 500.5, 500.5, 500,  500};
    const auto value = [&](const Eigen::Vector3i& v) { return profile[size_t(v.x())]; };
    const RawVolume region = regionOf(value, dims);
    const Eigen::Vector3d scan = Eigen::Vector3d::Constant(1e-3);
    const RawValues inner = innerValues(region, kBoneValue, scan);
    const RawValues surface = surfaceValues(region, inner, kBoneValue, scan);
    for (int x = 0; x < 16; ++x)
        EXPECT_EQ(at(surface, dims, {x, 1, 1}), x == 3 || x == 4 ? 1200 : profile[size_t(x)]) << x;
    EXPECT_EQ(at(inner, dims, {9, 1, 1}), 1200.5f) << "hardness has the densest in reach everywhere";
}

}  // namespace
}  // namespace bonemill
