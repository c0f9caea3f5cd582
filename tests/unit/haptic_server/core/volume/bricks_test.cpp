// Says what bricks cost, and that every copy of a voxel says the same.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::boxGeometry;
using test::forEachVoxel;

constexpr Density kIso = 30000;

// What the bricks hold, copies included, is compared with at().
void expectCopiesAgree(const VoxelVolume& volume) {
    const BrickStore& bricks = volume.bricks();
    BrickId id = 0;
    forEachIndex(bricks.allBricks(), [&](const Eigen::Vector3i& brick) {
        const Density* held = bricks.contents(id++);
        const Eigen::Vector3i first = brick.array() * kBrickCells - 1 - kBrickLow;
        forEachVoxel({first, first.array() + kBrickEdge - 1}, [&](int i, int j, int k) {
            const Eigen::Vector3i v(i, j, k);
            const bool is_data = (v.array() >= 0).all() && (v.array() < volume.dims().array()).all();
            ASSERT_EQ(*held++, is_data ? volume.at(i, j, k) : 0) << v.transpose();
        });
    });
}

VoxelVolume noise(const Eigen::Vector3i& dims, unsigned seed = 1) {
    VoxelVolume volume(boxGeometry(dims), kIso);
    std::mt19937 random(seed);
    std::vector<Density> densities(size_t(dims.prod()));
    for (Density& d : densities) d = Density(random());
    volume.fill([&](int i, int j, int k) { return densities[size_t(i + dims.x() * (j + dims.y() * k))]; });
    return volume;
}

TEST(Bricks, CopiesAgreeAfterFilling) {
    const auto density = [](int i, int j, int k) { return Density(1 + i + 64 * j + 1000 * k); };
    for (const Eigen::Vector3i& dims :
         std::vector<Eigen::Vector3i>{{1, 1, 1}, {14, 15, 16}, {17, 31, 33}, {47, 48, 49}}) {
        VoxelVolume volume(boxGeometry(dims), kIso);
        volume.fill(density);
        expectCopiesAgree(volume);
        forEachVoxel(test::wholeBox(volume),
                     [&](int i, int j, int k) { ASSERT_EQ(volume.at(i, j, k), density(i, j, k)); });
    }
}

TEST(Bricks, CopiesAgreeAfterWritesOfAnyLength) {
    std::mt19937 random(3);
    VoxelVolume volume(boxGeometry({50, 35, 33}), kIso), twin = volume;
    volume.makeSpareBricks(volume.bricks().brickCount());
    const auto below = [&](int n) { return int(random() % unsigned(n)); };
    for (int round = 0; round < 500; ++round) {
        const Eigen::Vector3i first(below(50), below(35), below(33));
        std::vector<Density> row(size_t(1 + below(50 - first.x())));
        for (Density& d : row) d = below(3) ? Density(random()) : below(2) ? 0 : kMaxDensity;
        ASSERT_TRUE(volume.openBricksIn({first, first + Eigen::Vector3i(int(row.size()) - 1, 0, 0)}));
        volume.writeRow(first, int(row.size()), row.data());
        for (int i = 0; i < int(row.size()); ++i)
            twin.set(first.x() + i, first.y(), first.z(), row[size_t(i)]);
        std::vector<Density> back(row.size() + VoxelVolume::kReadSlack);
        volume.readRow(first, int(row.size()), back.data());
        back.resize(row.size());
        ASSERT_EQ(back, row);
    }
    expectCopiesAgree(volume);
    forEachVoxel(test::wholeBox(volume),
                 [&](int i, int j, int k) { ASSERT_EQ(volume.at(i, j, k), twin.at(i, j, k)); });
}

TEST(Bricks, AirAndTheDensestBoneCostNothing) {
    VoxelVolume volume(boxGeometry({160, 160, 160}), kIso);
    EXPECT_EQ(volume.bricks().ownCount(), 0u);
    volume.fill([](int, int, int) { return kMaxDensity; });
    // There are 11 per axis; those at the border of air hold both. The last ones have their only voxel
    // in the border.
    EXPECT_EQ(volume.bricks().brickCount(), 11u * 11 * 11);
    EXPECT_EQ(volume.bricks().ownCount(), 11u * 11 * 11 - 8 * 8 * 8);
    volume.fill([](int, int, int) { return Density(0); });
    EXPECT_EQ(volume.bricks().ownCount(), 0u);
}

TEST(Bricks, OpeningChangesNoDensity) {
    VoxelVolume volume(boxGeometry({60, 60, 60}), kIso);
    volume.fill([](int, int, int) { return kMaxDensity; });
    const size_t before = volume.bricks().ownCount();
    volume.set(25, 25, 25, 7);
    EXPECT_EQ(volume.bricks().ownCount(), before + 1);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        ASSERT_EQ(volume.at(i, j, k), i == 25 && j == 25 && k == 25 ? 7 : kMaxDensity);
    });
}

TEST(Bricks, AreSharedAgainWhenTheyAreUniform) {
    VoxelVolume volume = noise({50, 40, 45});
    const size_t before = volume.bricks().ownCount();
    // Some bricks hold nothing else: two on each axis have all of their voxels in 0 .. 34.
    forEachVoxel({Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(34)},
                 [&](int i, int j, int k) { volume.set(i, j, k, 0); });
    const VoxelVolume unshared = volume;
    volume.shareUniformBricks();
    EXPECT_EQ(volume.bricks().ownCount(), before - 8);
    expectCopiesAgree(volume);
    forEachVoxel(test::wholeBox(volume),
                 [&](int i, int j, int k) { ASSERT_EQ(volume.at(i, j, k), unshared.at(i, j, k)); });
}

TEST(Bricks, AChangeOpensTheSharedOnesThatHoldIt) {
    VoxelVolume volume(boxGeometry({70, 20, 20}), kIso);
    volume.fill([](int, int, int) { return Density(0); });
    EXPECT_FALSE(volume.openBricksIn({{5, 5, 5}, {5, 5, 5}}));
    volume.makeSpareBricks(1);
    const Density density = 9;
    volume.writeRow({5, 5, 5}, 1, &density);
    EXPECT_EQ(volume.bricks().spareCount(), 0u);
    EXPECT_TRUE(volume.openBricksIn({{6, 6, 6}, {7, 7, 7}}));     // has its own now
    EXPECT_FALSE(volume.openBricksIn({{15, 5, 5}, {15, 5, 5}}));  // the next brick has a copy
    volume.writeRow({25, 5, 5}, 1, &density);                     // no spare one: nothing happens
    EXPECT_EQ(volume.at(25, 5, 5), 0);
    expectCopiesAgree(volume);
    const VoxelVolume copy = volume.withoutSpareBricks();
    EXPECT_EQ(copy.at(5, 5, 5), 9);
    expectCopiesAgree(copy);
}

TEST(Bricks, PartsMakeUpTheBoxAndLieInOneBrick) {
    const VoxelVolume volume = noise({50, 40, 45});
    std::mt19937 random(5);
    for (int round = 0; round < 100; ++round) {
        IndexBox box;
        for (int n = 0; n < 2; ++n)
            box.include({int(random() % 52) - 1, int(random() % 42) - 1, int(random() % 47) - 1});
        int64_t visited = 0;
        volume.forEachPart(box, [&](const IndexBox& part, size_t offset) {
            forEachVoxel(part, [&](int i, int j, int k) {
                const Eigen::Vector3i at = Eigen::Vector3i(i, j, k) - part.min;
                ASSERT_EQ(volume.at(offset + size_t(at.x()) + VoxelVolume::kStrideY * size_t(at.y()) +
                                    VoxelVolume::kStrideZ * size_t(at.z())),
                          volume.at(i, j, k));
                ++visited;
            });
        });
        EXPECT_EQ(visited, (box.max - box.min + Eigen::Vector3i::Ones()).cast<int64_t>().prod());
    }
}

}  // namespace
}  // namespace bonemill
