#include <gtest/gtest.h>

#include "haptic_server/server/session/device_link_io.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriod = 1'000'000;

TEST(TickPace, TheFirstTickWaitsForNothing) {
    const TickPace pace(kPeriod);
    EXPECT_LE(pace.earliestNs(), 0);
    EXPECT_FALSE(pace.isTooFast(0));
}

// A sample that comes when it should is never held back, whatever the jitter of the one before.
TEST(TickPace, ARegularDeviceIsNotHeldBack) {
    TickPace pace(kPeriod);
    for (int64_t tick = 0; tick < 1000; ++tick) {
        const int64_t due = tick * kPeriod, late = tick % 7 == 3 ? kPeriod / 2 : 0;
        EXPECT_LE(pace.earliestNs(), due + late) << tick;
        pace.begin(due + late);
    }
}

TEST(TickPace, AfterALateTickTheNextComesHalfAPeriodLaterAndIsNotCalledTooFast) {
    TickPace pace(kPeriod);
    for (int64_t tick = 0; tick < 10; ++tick) pace.begin(tick * kPeriod);
    const int64_t late = 10 * kPeriod + kPeriod * 8 / 10;
    pace.begin(late);
    EXPECT_EQ(pace.earliestNs(), late + kPeriod / 2);
    EXPECT_FALSE(pace.isTooFast(11 * kPeriod));
}

TEST(TickPace, AFloodIsHeldToThePeriodAndAClockThatIsATouchFasterIsNot) {
    TickPace flood(kPeriod), fast_clock(kPeriod);
    int64_t start = 0;
    flood.begin(start);
    int too_fast = 0;
    constexpr int kTicks = 1000;
    for (int tick = 1; tick <= kTicks; ++tick) {
        too_fast += flood.isTooFast(start + 1);
        const int64_t next = flood.earliestNs();
        EXPECT_GE(next - start, kPeriod / 2);
        flood.begin(start = next);
    }
    EXPECT_GE(start, (kTicks - 3) * (kPeriod - kPeriod / 64));
    EXPECT_GT(too_fast, kTicks - 10);
    constexpr int64_t kFastPeriod = kPeriod * 99 / 100;
    for (int64_t tick = 0; tick < 1000; ++tick) {
        EXPECT_FALSE(fast_clock.isTooFast(tick * kFastPeriod)) << tick;
        fast_clock.begin(tick * kFastPeriod);
    }
}

// Samples wait for a tick that takes the whole period or more: it would never rest.
TEST(TickPace, ALoopWhoseTicksFillTheirPeriodRestsForAFifthOfTheTime) {
    for (const int64_t work : {kPeriod * 9 / 10, kPeriod, 5 * kPeriod}) {
        TickPace pace(kPeriod);
        int64_t now = 0, worked = 0;
        while (now < 1000 * kPeriod) {
            now = std::max(now, pace.earliestNs());
            pace.begin(now);
            now += work, worked += work;
            pace.end(now);
        }
        EXPECT_LT(double(worked) / double(now), 0.81) << work;
        EXPECT_GT(double(worked) / double(now), 0.79) << work;
    }
}

TEST(TickPace, ATickThatLeavesAFifthOfItsPeriodIsNotHeldBackForARest) {
    TickPace pace(kPeriod);
    for (int64_t tick = 0; tick < 1000; ++tick) {
        EXPECT_LE(pace.earliestNs(), tick * kPeriod) << tick;
        pace.begin(tick * kPeriod);
        pace.end(tick * kPeriod + kPeriod * 4 / 5);
    }
}

}  // namespace
}  // namespace bonemill
