#include "haptic_server/core/volume/voxel_volume.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::boxGeometry;
using test::forEachVoxel;

TEST(VoxelVolume, StartsAsAirWithAReadableBorder) {
    const VoxelVolume volume(boxGeometry({3, 4, 5}), 1000);
    forEachVoxel({Eigen::Vector3i::Constant(-1), volume.dims()},
                 [&](int i, int j, int k) { EXPECT_EQ(volume.at(i, j, k), 0); });
}

TEST(VoxelVolume, EveryVoxelAndBorderHasItsOwnPlace) {
    VoxelVolume volume(boxGeometry({30, 4, 5}), 1000);
    volume.fill([](int i, int j, int k) { return Density(1 + i + 10 * j + 100 * k); });
    std::set<size_t> offsets;
    forEachVoxel({Eigen::Vector3i::Constant(-1), volume.dims()},
                 [&](int i, int j, int k) { offsets.insert(volume.offset(i, j, k)); });
    EXPECT_EQ(offsets.size(), 32u * 6 * 7);
    EXPECT_EQ(volume.at(volume.offset(1, 2, 3) + VoxelVolume::kStrideY), volume.at(1, 3, 3));
    EXPECT_EQ(volume.at(volume.offset(1, 2, 3) + VoxelVolume::kStrideZ), volume.at(1, 2, 4));
}

TEST(VoxelVolume, SetReachesOneVoxelOnly) {
    VoxelVolume volume(boxGeometry({3, 3, 3}), 1000);
    volume.set(2, 0, 1, 777);
    forEachVoxel({Eigen::Vector3i::Constant(-1), volume.dims()}, [&](int i, int j, int k) {
        EXPECT_EQ(volume.at(i, j, k), i == 2 && j == 0 && k == 1 ? 777 : 0);
    });
}

TEST(VoxelVolume, GradientOfALinearFieldIsExactInside) {
    const Eigen::Vector3d spacing(0.0004, 0.0005, 0.0008);
    VoxelVolume volume(boxGeometry({8, 8, 8}, spacing), 1000);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        volume.set(i, j, k, Density(5000 + 100 * i - 70 * j + 30 * k));
    });
    forEachVoxel({Eigen::Vector3i::Constant(1), Eigen::Vector3i::Constant(6)}, [&](int i, int j, int k) {
        const Eigen::Vector3f g = volume.gradient(i, j, k);
        EXPECT_NEAR(g.x(), 100 / 0.0004, 1);
        EXPECT_NEAR(g.y(), -70 / 0.0005, 1);
        EXPECT_NEAR(g.z(), 30 / 0.0008, 1);
    });
}

TEST(VoxelVolume, GradientAtTheDataEdgeSeesTheAir) {
    VoxelVolume volume(boxGeometry({4, 4, 4}, Eigen::Vector3d::Constant(0.001)), 1000);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) { volume.set(i, j, k, 6000); });
    EXPECT_FLOAT_EQ(volume.gradient(0, 1, 1).x(), 6000 / 0.002f);
    EXPECT_FLOAT_EQ(volume.gradient(3, 1, 1).x(), -6000 / 0.002f);
    EXPECT_FLOAT_EQ(volume.gradient(0, 1, 1).y(), 0);
}

// In the border the outer neighbour is missing: the gradient is the difference to the inner one
// over one step.
TEST(VoxelVolume, GradientInTheBorderIsOneSided) {
    VoxelVolume volume(boxGeometry({4, 4, 4}, Eigen::Vector3d::Constant(0.001)), 1000);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) { volume.set(i, j, k, 6000); });
    for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3i low = Eigen::Vector3i::Constant(1);
        Eigen::Vector3i high = low;
        low[axis] = -1;
        high[axis] = 4;
        const Eigen::Vector3f expected = Eigen::Vector3f::Unit(axis) * (6000 / 0.001f);
        EXPECT_TRUE(volume.gradient(low.x(), low.y(), low.z()).isApprox(expected, 1e-6f));
        EXPECT_TRUE(volume.gradient(high.x(), high.y(), high.z()).isApprox(-expected, 1e-6f));
    }
    EXPECT_EQ(volume.gradient(-1, -1, -1), Eigen::Vector3f::Zero());
    EXPECT_EQ(volume.gradient(4, 4, 4), Eigen::Vector3f::Zero());
}

TEST(VoxelVolume, VoxelVolumeIsTheProductOfTheSpacing) {
    const VoxelVolume volume(boxGeometry({1, 1, 1}, {0.001, 0.002, 0.003}), 1000);
    EXPECT_DOUBLE_EQ(volume.voxelVolume(), 6e-9);
}

}  // namespace
}  // namespace bonemill
