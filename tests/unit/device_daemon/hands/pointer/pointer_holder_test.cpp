// One viewer holds the tool at a time.
#include <gtest/gtest.h>

#include "device_daemon/hands/pointer/hand_wish.h"

namespace bonemill {
namespace {

constexpr int64_t kMs = 1'000'000;

HandWish wishOf(uint64_t sender, uint32_t sequence, bool is_holding = true) {
    HandWish wish;
    wish.sender = sender;
    wish.sequence = sequence;
    wish.may_hold = true;
    wish.is_holding = is_holding;
    return wish;
}

TEST(PointerHolder, TheFirstViewerHoldsUntilItLetsGo) {
    PointerHolder holder;
    EXPECT_FALSE(holder.holder(0));
    EXPECT_TRUE(holder.take(wishOf(1, 1), 0));
    EXPECT_FALSE(holder.take(wishOf(2, 1), 10 * kMs));
    EXPECT_FALSE(holder.take(wishOf(2, 2, false), 20 * kMs)) << "and nobody lets go for it";
    EXPECT_EQ(holder.holder(20 * kMs), 1u);
    EXPECT_TRUE(holder.take(wishOf(1, 2, false), 30 * kMs));
    EXPECT_FALSE(holder.holder(30 * kMs));
    EXPECT_TRUE(holder.take(wishOf(2, 3), 40 * kMs));
    EXPECT_FALSE(holder.take(wishOf(1, 3), 50 * kMs));
}

TEST(PointerHolder, ASilentViewerLosesTheTool) {
    PointerHolder holder;
    EXPECT_TRUE(holder.take(wishOf(1, 1), 0));
    EXPECT_FALSE(holder.take(wishOf(2, 1), 999 * kMs));
    EXPECT_TRUE(holder.take(wishOf(2, 2), 1001 * kMs));
    EXPECT_FALSE(holder.take(wishOf(1, 2), 1002 * kMs));
}

TEST(PointerHolder, OldWishesDoNotCount) {
    PointerHolder holder;
    EXPECT_TRUE(holder.take(wishOf(1, 0xfffffffe), 0));
    EXPECT_FALSE(holder.take(wishOf(1, 0xfffffffe), 1));
    EXPECT_FALSE(holder.take(wishOf(1, 0xfffffffd), 2));
    EXPECT_TRUE(holder.take(wishOf(1, 2), 3)) << "the counter has wrapped around";
}

TEST(PointerHolder, WhoMayNotHoldDoesNot) {
    PointerHolder holder;
    HandWish wish = wishOf(1, 1);
    wish.may_hold = false;
    EXPECT_FALSE(holder.take(wish, 0));
    EXPECT_FALSE(holder.holder(0));
}

}  // namespace
}  // namespace bonemill
