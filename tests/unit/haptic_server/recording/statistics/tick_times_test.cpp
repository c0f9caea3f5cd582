#include "haptic_server/recording/statistics/tick_times.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

TEST(TickTimes, PercentilesOfAKnownList) {
    std::vector<int64_t> durations_ns;
    for (int64_t us = 2000; us >= 1; --us) durations_ns.push_back(us * 1000);
    const TickTimes times = timesOf(durations_ns);
    EXPECT_EQ(times.p50, 1000);
    EXPECT_EQ(times.p99, 1980);
    EXPECT_EQ(times.p99_9, 1998);
    EXPECT_EQ(times.max, 2000);
    EXPECT_EQ(timesOf({7000}).p50, 7);
    EXPECT_EQ(timesOf({}).max, 0);
}

}  // namespace
}  // namespace bonemill
