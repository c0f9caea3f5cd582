#include <gtest/gtest.h>

#include <random>

#include "haptic_server/server/session/device_link_io.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriodNs = 1'000'000;

TEST(LivedPeriods, AreOneEachWhenTicksComeInTime) {
    LivedPeriods lived(kPeriodNs);
    std::mt19937 random(3);
    std::uniform_int_distribution<int64_t> late_ns(-100'000, 400'000);
    for (int n = 0; n < 1000; ++n) EXPECT_EQ(lived.begin(n * kPeriodNs + (n ? late_ns(random) : 0)), 1) << n;
}

TEST(LivedPeriods, AreAllThatPassedSinceTheTickBefore) {
    LivedPeriods lived(kPeriodNs);
    EXPECT_EQ(lived.begin(50 * kPeriodNs), 1);
    EXPECT_EQ(lived.begin(51 * kPeriodNs), 1);
    EXPECT_EQ(lived.begin(58 * kPeriodNs), 7);
    EXPECT_EQ(lived.begin(59 * kPeriodNs), 1);
}

// A late tick and those that catch up with it live no longer than the clock.
TEST(LivedPeriods, AddUpToTheTimeThatPassed) {
    LivedPeriods lived(kPeriodNs);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> step(0, 20);
    int64_t now = 7 * kPeriodNs, sum = lived.begin(now) - 1;
    const auto tick = [&](int64_t after_ns) {
        now += after_ns;
        sum += lived.begin(now);
        EXPECT_NEAR(double(sum), double(now) / kPeriodNs - 7, 2.5);
    };
    for (int n = 0; n < 20'000; ++n) {
        const int kind = step(random);
        if (kind > 0) {
            tick(kPeriodNs + 1000 * (kind - 10));
            continue;
        }
        tick(9 * kPeriodNs);
        for (const int64_t catching_up : {kPeriodNs / 2, kPeriodNs / 2}) tick(catching_up);
    }
}

TEST(LivedPeriods, AreBoundedAfterALongBreak) {
    LivedPeriods lived(kPeriodNs), slow(30'000'000);
    for (const int64_t now : {int64_t(0), int64_t(5'000'000'000)}) {
        lived.begin(now);
        slow.begin(now);
    }
    EXPECT_EQ(lived.begin(10'000'000'000), LivedPeriods::kMaxNs / kPeriodNs);
    EXPECT_EQ(lived.begin(10'001'000'000), 1);
    EXPECT_EQ(slow.begin(10'000'000'000), 1);
}

}  // namespace
}  // namespace bonemill
