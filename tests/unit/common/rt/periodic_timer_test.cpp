#include "common/rt/periodic_timer.h"

#include <gtest/gtest.h>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriodNs = kNsPerMillisecond;
constexpr int64_t kStartNs = 5 * kNsPerSecond;

TEST(PeriodicTimer, keepsItsGridWhileWorkFitsThePeriod) {
    PeriodicTimer timer(kPeriodNs, kStartNs);
    int64_t now_ns = kStartNs;
    for (int64_t i = 1; i <= 1000; ++i) {
        ASSERT_EQ(timer.advance(now_ns), kStartNs + i * kPeriodNs);
        now_ns = kStartNs + i * kPeriodNs + (i * 7919) % kPeriodNs;  // late, but within the period
    }
    EXPECT_EQ(timer.missedPeriods(), 0u);
}

TEST(PeriodicTimer, skipsAndCountsWhatWasMissed) {
    PeriodicTimer timer(kPeriodNs, kStartNs);
    EXPECT_EQ(timer.advance(kStartNs), kStartNs + kPeriodNs);
    // The work of tick 1 lasts until 4.3: the instants 2 and 3 are lost, 4 is served late.
    EXPECT_EQ(timer.advance(kStartNs + 43 * kPeriodNs / 10), kStartNs + 4 * kPeriodNs);
    EXPECT_EQ(timer.missedPeriods(), 2u);
    EXPECT_EQ(timer.advance(kStartNs + 44 * kPeriodNs / 10), kStartNs + 5 * kPeriodNs);
    EXPECT_EQ(timer.missedPeriods(), 2u);
}

TEST(PeriodicTimer, neverWakesBeforeItsInstant) {
    PeriodicTimer timer(kPeriodNs, monotonicNowNs());
    int64_t last_ns = 0;
    for (int i = 0; i < 20; ++i) {
        const int64_t instant_ns = timer.waitNext();
        EXPECT_GE(monotonicNowNs(), instant_ns);
        EXPECT_GT(instant_ns, last_ns);
        last_ns = instant_ns;
    }
}

}  // namespace
}  // namespace bonemill
