// A list of the pool's blocks holds what a map would, whatever is replaced in it.
#include "haptic_server/core/contact/shell_pool.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "haptic_server/core/contact/fresh_points.h"

namespace bonemill {
namespace {

constexpr int kEdge = 12;  // blocks of a leaf per axis
constexpr size_t kMost = size_t(kEdge) * kEdge * kEdge;

struct PoolCase {
    ShellPool pool{kMost};
    ShellPool::List list;
    FreshPoints fresh{kMost};
    std::map<BlockKey, float> shall;  // areas
    std::mt19937 random{7};

    int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); }
    IndexBox someBox() {
        IndexBox box;
        for (int n = 0; n < 2; ++n) box.include(Eigen::Vector3i(below(kEdge), below(kEdge), below(kEdge)));
        return box;
    }
    // One of so many blocks of the box is without a point; -1: those that have one keep it, and no other.
    void makeFresh(const IndexBox& box, int without) {
        fresh.clear();
        forEachIndex(box, [&](const Eigen::Vector3i& index) {
            const BlockKey key = BlockKey::of(index);
            if (without < 0 ? !shall.contains(key) : below(without) == 0) return;
            const float area = float(1 + below(1000));
            fresh.add({Eigen::Vector3f::Constant(area), Eigen::Vector3f::Constant(-area), area, key});
        });
    }
    void expectTheMap() {
        auto next = shall.begin();
        size_t blocks = 0;
        pool.forEachBlock(list, [&](const ShellBlock& b, uint32_t count) {
            ++blocks;
            for (uint32_t i = 0; i < count; ++i, ++next) {
                ASSERT_NE(next, shall.end());
                ASSERT_EQ(b.key[i], next->first);
                for (const float* values : {b.x, b.y, b.z, b.area}) ASSERT_EQ(values[i], next->second);
                for (const float* values : {b.nx, b.ny, b.nz}) ASSERT_EQ(values[i], -next->second);
                ASSERT_LE(std::abs(b.x[i] - b.center[0]), b.radius);
            }
        });
        ASSERT_EQ(next, shall.end());
        ASSERT_EQ(list.count, shall.size());
        ASSERT_EQ(pool.freeCount() + blocks, pool.blockCount());
    }
};

TEST(ShellPool, HoldsWhatAMapWould) {
    PoolCase c;
    c.pool.addBlocks(kMost / ShellBlock::kCapacity + 1);
    size_t longest = 0;
    for (int round = 0; round < 3000; ++round) {
        const IndexBox box = c.someBox();
        const int without[] = {-1, 1, 2, 2, 4, 50};  // 1: all points of the box go
        c.makeFresh(box, without[c.below(6)]);
        const ShellPoints points = c.fresh.points();
        const BlockKeyBox keys(box);
        const uint32_t revision = c.list.revision;
        const bool is_something = c.list.count > 0 || points.count > 0;
        ASSERT_TRUE(c.pool.replace(c.list, keys, points));
        EXPECT_EQ(c.list.revision != revision, is_something);
        std::erase_if(c.shall, [&](const auto& point) { return keys.contains(point.first); });
        for (size_t n = 0; n < points.count; ++n) c.shall[points.key[n]] = points.area[n];
        longest = std::max(longest, c.shall.size());
        ASSERT_NO_FATAL_FAILURE(c.expectTheMap()) << "round " << round;
    }
    EXPECT_GT(longest, 5 * ShellBlock::kCapacity);
}

TEST(ShellPool, KeepsTheListWhenItIsFull) {
    PoolCase c;
    c.pool.addBlocks(1);
    c.makeFresh({{0, 0, 0}, {3, 3, 3}}, kMost);
    const ShellPoints few = c.fresh.points();
    for (size_t n = 0; n < few.count; ++n) c.shall[few.key[n]] = few.area[n];
    ASSERT_TRUE(c.pool.replace(c.list, BlockKeyBox({{0, 0, 0}, {3, 3, 3}}), few));
    ASSERT_NO_FATAL_FAILURE(c.expectTheMap());
    c.makeFresh({{4, 0, 0}, {9, 9, 9}}, kMost);
    EXPECT_FALSE(c.pool.replace(c.list, BlockKeyBox({{4, 0, 0}, {9, 9, 9}}), c.fresh.points()));
    ASSERT_NO_FATAL_FAILURE(c.expectTheMap());
}

}  // namespace
}  // namespace bonemill
