#include "render_client/link/density_store/density_store.h"

#include <gtest/gtest.h>

#include "tests/support/stored_density.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr size_t kBrickBytes = 4 * 4 * 4 * 2;

// 3 × 2 × 2 bricks of 4³; the last ones reach beyond the grid.
DensityGrid smallGrid() {
    return {{10, 7, 5}, Vector3d::Constant(1e-3), Vector3d::Zero(), 4, -1000, 3000, 300};
}

DensityBrick brickOf(uint16_t first) {
    DensityBrick brick;
    for (uint16_t i = 0; i < 64; ++i) brick.scanned.push_back(uint16_t(first + i));
    return brick;
}

TEST(DensityGrid, NumbersItsBricks) {
    const DensityGrid grid = smallGrid();
    EXPECT_EQ(brickCount(grid), 12);
    EXPECT_EQ(brickOf(grid, {0, 0, 0}), 0u);
    EXPECT_EQ(brickOf(grid, {9, 6, 4}), 11u);
    for (uint32_t brick = 0; brick < 12; ++brick) EXPECT_EQ(brickOf(grid, firstVoxelOf(grid, brick)), brick);
    EXPECT_EQ(firstVoxelOf(grid, 4), Vector3i(4, 4, 0));
}

TEST(DensityStore, HasWhatArrived) {
    DensityStore store;
    store.setGrid(smallGrid());
    EXPECT_EQ(store.find(5), nullptr);
    EXPECT_EQ(scannedAt(store, {8, 4, 0}), std::nullopt);
    store.put(5, brickOf(100));  // its first voxel is (8, 4, 0)
    ASSERT_NE(store.find(5), nullptr);
    EXPECT_EQ(scannedAt(store, {8, 4, 0}), 100);
    EXPECT_EQ(scannedAt(store, {9, 6, 3}), 100 + 1 + 4 * 2 + 16 * 3);
    EXPECT_EQ(presentAt(store, {9, 6, 3}), 100 + 1 + 4 * 2 + 16 * 3);
    EXPECT_EQ(scannedAt(store, {10, 6, 3}), std::nullopt) << "outside of the grid";
    EXPECT_EQ(scannedAt(store, {-1, 0, 0}), std::nullopt);
    DensityBrick milled = brickOf(100);
    milled.present.assign(64, 7);
    milled.materials.assign(64, 3);
    store.put(5, milled);
    EXPECT_EQ(scannedAt(store, {9, 4, 0}), 101);
    EXPECT_EQ(presentAt(store, {9, 4, 0}), 7);
    EXPECT_EQ(store.bytes(), 2 * kBrickBytes + 64);
}

TEST(DensityStore, LetsTheLeastRecentlyWantedGoFirst) {
    DensityStore store(3 * kBrickBytes);
    store.setGrid(smallGrid());
    store.want({0, 1, 2});
    for (uint32_t brick : {0, 1, 2}) store.put(brick, brickOf(0));
    store.want({1, 0});
    store.want({3});
    store.put(3, brickOf(0));
    EXPECT_EQ(store.find(2), nullptr) << "it was not wanted for longest";
    store.want({4});
    store.put(4, brickOf(0));
    EXPECT_EQ(store.find(0), nullptr) << "the more important of a wish stays";
    EXPECT_NE(store.find(1), nullptr);
    EXPECT_EQ(store.bytes(), 3 * kBrickBytes);
    store.put(5, brickOf(0));
    EXPECT_EQ(store.find(5), nullptr) << "nobody wants it, and the store is full";
    EXPECT_NE(store.find(1), nullptr);
}

TEST(DensityStore, CountsWhatComesAndGoes) {
    DensityStore store(kBrickBytes);
    const uint64_t start = store.changes();
    store.setGrid(smallGrid());
    store.put(0, brickOf(0));
    const uint64_t one = store.changes();
    EXPECT_GT(one, start);
    store.want({1});
    store.setGrid(smallGrid());
    EXPECT_EQ(store.changes(), one) << "the same grid changes nothing";
    EXPECT_NE(store.find(0), nullptr);
    store.put(1, brickOf(0));
    EXPECT_EQ(store.changes(), one + 2) << "one came, one went";
    DensityGrid other = smallGrid();
    other.iso_value = 200;
    store.setGrid(other);
    EXPECT_EQ(store.find(1), nullptr);
    EXPECT_TRUE(store.wanted().empty());
    EXPECT_GT(store.changes(), one + 2);
    EXPECT_EQ(store.bytes(), 0u);
}

TEST(DensityStore, WantsOnlyWhatTheGridHas) {
    DensityStore store;
    store.want({0});
    EXPECT_TRUE(store.wanted().empty()) << "there is no grid yet";
    store.setGrid(smallGrid());
    store.want({11, 12, 4000000000u, 3});
    EXPECT_EQ(store.wanted(), (std::vector<uint32_t>{11, 3}));
}

}  // namespace
}  // namespace bonemill
