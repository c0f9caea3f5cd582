#include <gtest/gtest.h>

#include <cstring>

#include "haptic_server/scans/densify/densify.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr Density kIso = 30000;

// The bone lies in one corner of soft tissue that is nowhere the same.
VoxelVolume boneInTissue() {
    VoxelVolume volume(test::boxGeometry({100, 90, 80}), kIso);
    volume.fill([](int i, int j, int k) {
        const bool is_bone = (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(20, 18, 22)).norm() < 9.3;
        return Density((is_bone ? 40000 : 10000) + (i * 7 + j * 13 + k * 29) % 1000);
    });
    return volume;
}

TEST(FarAir, IsClearedAndCostsNothing) {
    VoxelVolume volume = boneInTissue();
    const size_t before = volume.bricks().ownCount();
    clearFarFromBone(volume);
    EXPECT_LT(volume.bricks().ownCount(), before / 2);
    EXPECT_EQ(volume.at(90, 80, 70), 0);
    EXPECT_EQ(volume.at(20, 18, 79), 0);
}

TEST(FarAir, NothingWithin16VoxelsOfBoneChanges) {
    const VoxelVolume before = boneInTissue();
    VoxelVolume after = before;
    clearFarFromBone(after);
    test::forEachVoxel(test::wholeBox(before), [&](int i, int j, int k) {
        const Eigen::Array3d off = (Eigen::Array3d(i, j, k) - Eigen::Array3d(20, 18, 22)).abs();
        if (off.maxCoeff() <= 9 + 16) {
            ASSERT_EQ(after.at(i, j, k), before.at(i, j, k));
        } else {
            ASSERT_TRUE(after.at(i, j, k) == before.at(i, j, k) || after.at(i, j, k) == 0);
        }
    });
}

TEST(FarAir, TheSurfaceIsTheSameBitForBit) {
    const VoxelVolume before = boneInTissue();
    VoxelVolume after = before;
    clearFarFromBone(after);
    const LeafLattice old_lattice(before, {16, 16, 16}), new_lattice(after, {16, 16, 16});
    const auto old_meshes = test::meshAll(before, old_lattice),
               new_meshes = test::meshAll(after, new_lattice);
    ASSERT_EQ(old_meshes.size(), new_meshes.size());
    for (size_t n = 0; n < old_meshes.size(); ++n) {
        EXPECT_EQ(old_meshes[n].indices, new_meshes[n].indices);
        EXPECT_EQ(std::memcmp(old_meshes[n].vertices.data(), new_meshes[n].vertices.data(),
                              old_meshes[n].vertices.size() * sizeof old_meshes[n].vertices[0]),
                  0);
    }
}

TEST(FarAir, StaysInBricksWithAVoxelThatIsKept) {
    const VoxelVolume before = boneInTissue();
    VoxelVolume after = before;
    const auto index = [](int i, int j, int k) { return size_t(i + 100 * (j + 90 * k)); };
    clearFarFromBone(after, [&](size_t at) { return at == index(90, 80, 70); });
    for (const int i : {80, 90, 94}) EXPECT_EQ(after.at(i, 80, 70), before.at(i, 80, 70)) << i;
    EXPECT_EQ(after.at(78, 80, 70), 0) << "the brick beside it";
    EXPECT_EQ(after.at(20, 18, 79), 0);
}

TEST(FarAir, WithoutAnyBoneAllIsAir) {
    VoxelVolume volume(test::boxGeometry({40, 40, 40}), kIso);
    volume.fill([](int i, int, int) { return Density(i); });
    clearFarFromBone(volume);
    EXPECT_EQ(volume.bricks().ownCount(), 0u);
    EXPECT_EQ(volume.at(30, 3, 3), 0);
}

}  // namespace
}  // namespace bonemill
