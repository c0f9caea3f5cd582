#include "common/rt/seqlock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace bonemill {
namespace {

struct Value {
    uint64_t number;
    uint64_t copies[12];
    uint32_t low;  // the size is no multiple of a word before padding
};

Value valueOf(uint64_t number) {
    Value value{};
    value.number = number;
    for (uint64_t& copy : value.copies) copy = number;
    value.low = uint32_t(number);
    return value;
}

bool isWhole(const Value& value) {
    for (const uint64_t copy : value.copies) {
        if (copy != value.number) return false;
    }
    return value.low == uint32_t(value.number);
}

TEST(Seqlock, hasNothingBeforeTheFirstWrite) {
    const Seqlock<Value> lock;
    Value value = valueOf(7);
    EXPECT_FALSE(lock.tryRead(value));
    EXPECT_EQ(value.number, 7u);
}

TEST(Seqlock, readsTheNewestValueAndItsVersion) {
    Seqlock<Value> lock;
    Value value{};
    uint32_t first = 0, again = 0, second = 0;
    lock.write(valueOf(1));
    ASSERT_TRUE(lock.tryRead(value, &first));
    ASSERT_TRUE(lock.tryRead(value, &again));
    EXPECT_EQ(value.number, 1u);
    EXPECT_EQ(first, again);
    lock.write(valueOf(2));
    ASSERT_TRUE(lock.tryRead(value, &second));
    EXPECT_EQ(value.number, 2u);
    EXPECT_NE(first, second);
}

struct Bytes5 {
    unsigned char bytes[5];
};

TEST(Seqlock, keepsValuesSmallerThanAWord) {
    Seqlock<Bytes5> lock;
    lock.write({{1, 2, 3, 4, 250}});
    Bytes5 read{};
    ASSERT_TRUE(lock.tryRead(read));
    EXPECT_EQ(read.bytes[0], 1);
    EXPECT_EQ(read.bytes[4], 250);
}

// The counter is the first member of a standard-layout class.
std::atomic<uint32_t>& counterOf(Seqlock<Value>& lock) {
    return const_cast<std::atomic<uint32_t>&>(lock.counter());
}

TEST(Seqlock, refusesAHalfWrittenValueUntilTheNextWriterRepairsIt) {
    Seqlock<Value> lock;
    lock.write(valueOf(1));
    counterOf(lock).fetch_add(1);  // as a writer leaves it that dies between its two stores
    Value value{};
    EXPECT_FALSE(lock.tryRead(value));
    lock.write(valueOf(2));
    ASSERT_TRUE(lock.tryRead(value));
    EXPECT_EQ(value.number, 2u);
}

TEST(Seqlock, countsPastTheEndWithoutLookingUnwritten) {
    Seqlock<Value> lock;
    counterOf(lock).store(UINT32_MAX - 3);
    Value value{};
    for (uint64_t i = 0; i < 4; ++i) {
        lock.write(valueOf(i));
        ASSERT_TRUE(lock.tryRead(value)) << i;
        EXPECT_EQ(value.number, i);
    }
}

TEST(Seqlock, neverGivesATornValueAndNeverAnOlderOne) {
    constexpr int kDifferentValues = 2'000;  // enough to meet many writes half done
    Seqlock<Value> lock;
    std::atomic<bool> is_enough{false};
    std::thread writer([&] {
        for (uint64_t i = 1; !is_enough.load(std::memory_order_relaxed); ++i) {
            lock.write(valueOf(i));
            std::this_thread::yield();  // a gap, or the reader would hardly ever get through
        }
    });
    uint64_t last = 0, torn = 0, older = 0;
    for (int different = 0; different < kDifferentValues;) {
        Value value{};
        if (!lock.tryRead(value)) continue;
        torn += !isWhole(value);
        older += value.number < last;
        different += value.number != last;
        last = value.number;
    }
    is_enough = true;
    writer.join();
    EXPECT_EQ(torn, 0u);
    EXPECT_EQ(older, 0u);
}

}  // namespace
}  // namespace bonemill
