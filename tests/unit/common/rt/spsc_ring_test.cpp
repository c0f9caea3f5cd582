#include "common/rt/spsc_ring.h"

#include <gtest/gtest.h>

#include <thread>

namespace bonemill {
namespace {

TEST(SpscRing, roundsItsCapacityUp) {
    EXPECT_EQ(SpscRing<int>(0).capacity(), 1u);
    EXPECT_EQ(SpscRing<int>(5).capacity(), 8u);
    EXPECT_EQ(SpscRing<int>(8).capacity(), 8u);
}

TEST(SpscRing, isFirstInFirstOut) {
    SpscRing<int> ring(4);
    int item = -1;
    EXPECT_FALSE(ring.tryPop(item));
    EXPECT_EQ(item, -1);
    for (int round = 0; round < 10; ++round) {
        for (int i = 0; i < 3; ++i) ASSERT_TRUE(ring.tryPush(10 * round + i));
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(ring.tryPop(item));
            EXPECT_EQ(item, 10 * round + i);
        }
    }
    EXPECT_EQ(ring.dropped(), 0u);
}

TEST(SpscRing, dropsAndCountsWhenFull) {
    SpscRing<int> ring(4);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(ring.tryPush(i));
    EXPECT_FALSE(ring.tryPush(4));
    EXPECT_FALSE(ring.tryPush(5));
    EXPECT_EQ(ring.dropped(), 2u);
    int item = -1;
    ASSERT_TRUE(ring.tryPop(item));
    EXPECT_EQ(item, 0);  // what was there stays: the new item is the one dropped
    EXPECT_TRUE(ring.tryPush(6));
    for (const int expected : {1, 2, 3, 6}) {
        ASSERT_TRUE(ring.tryPop(item));
        EXPECT_EQ(item, expected);
    }
}

struct Item {
    uint64_t number;
    uint64_t inverted;
};

TEST(SpscRing, handsOverEveryItemWholeAndInOrder) {
    constexpr uint64_t kItems = 200'000;
    SpscRing<Item> ring(64);
    uint64_t pushed = 0;
    std::thread producer([&] {
        for (uint64_t i = 0; i < kItems; ++i) pushed += ring.tryPush({i, ~i});
        while (!ring.tryPush({kItems, ~kItems})) std::this_thread::yield();
    });
    uint64_t popped = 0, wrong = 0, next = 0;
    for (Item item{}; item.number != kItems;) {
        if (!ring.tryPop(item)) continue;
        wrong += item.inverted != ~item.number || item.number < next;
        next = item.number + 1;
        ++popped;
    }
    producer.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(popped, pushed + 1);
    EXPECT_GE(ring.dropped(), kItems - pushed);  // the last item may have been refused a few times
}

}  // namespace
}  // namespace bonemill
