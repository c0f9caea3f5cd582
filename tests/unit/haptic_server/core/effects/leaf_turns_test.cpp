// Leaves share the ticks evenly.
#include "haptic_server/core/effects/energy_removal/leaf_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace bonemill {
namespace {

TEST(LeafTurns, TheFullestLeafHasATickOfItsOwn) {
    LeafTurns turns;
    turns.count(7, 100);
    for (const LeafId leaf : {3u, 5u, 9u}) turns.count(leaf, 30);
    turns.count(7, 50);
    turns.share(2);
    for (const LeafId leaf : {3u, 5u, 9u}) EXPECT_NE(turns.turnOf(leaf, 2), turns.turnOf(7, 2)) << leaf;
}

TEST(LeafTurns, LeavesThatWereNotCountedTakeTurnsByTheirNumber) {
    LeafTurns turns;
    turns.count(8, 10);
    turns.share(3);
    for (LeafId leaf = 20; leaf < 26; ++leaf) EXPECT_EQ(turns.turnOf(leaf, 3), leaf % 3);
    turns.clear();
    EXPECT_EQ(turns.turnOf(8, 3), 8u % 3);
}

// Whatever the leaves hold.
TEST(LeafTurns, NoTickHasMoreThanAnotherByMoreThanTheFullestLeaf) {
    std::mt19937 random(11);
    for (int round = 0; round < 2000; ++round) {
        const size_t shares = 1 + random() % 8;
        std::vector<size_t> patches(1 + random() % LeafTurns::kMaxLeaves);
        LeafTurns turns;
        for (size_t n = 0; n < patches.size(); ++n)
            turns.count(LeafId(3 * n), patches[n] = 1 + random() % 400);
        turns.share(shares);
        std::array<size_t, 8> sums{};
        for (size_t n = 0; n < patches.size(); ++n) {
            const size_t turn = turns.turnOf(LeafId(3 * n), shares);
            ASSERT_LT(turn, shares);
            sums[turn] += patches[n];
        }
        const auto [least, most] = std::minmax_element(sums.begin(), sums.begin() + ptrdiff_t(shares));
        EXPECT_LE(*most - *least, *std::ranges::max_element(patches));
    }
}

TEST(LeafTurns, MoreLeavesThanThereIsRoomForStillHaveATick) {
    LeafTurns turns;
    for (LeafId leaf = 0; leaf < 2 * LeafTurns::kMaxLeaves; ++leaf) turns.count(leaf, 1);
    turns.share(4);
    for (LeafId leaf = 0; leaf < 2 * LeafTurns::kMaxLeaves; ++leaf) EXPECT_LT(turns.turnOf(leaf, 4), 4u);
}

}  // namespace
}  // namespace bonemill
