#include "haptic_server/recording/align/clock_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bonemill {
namespace {

TEST(ClockFit, FindsOffsetAndRateOfAClockThatCountsFrom1970) {
    std::vector<ClockPair> pairs;
    for (int n = 0; n < 600; ++n) {
        const double session_s = 3 + 0.2 * n;
        pairs.push_back({1.7e9 + session_s * (1 + 40e-6), session_s});
    }
    const ClockFit fit = fitClock(pairs);
    EXPECT_EQ(fit.pairs, 600u);
    EXPECT_NEAR(fit.rate, 1 / (1 + 40e-6), 1e-8);
    for (const ClockPair& pair : pairs) EXPECT_NEAR(fit.sessionOf(pair.foreign), pair.session_s, 1e-6);
    EXPECT_LT(fit.max_s, 1e-6);
}

// The residual is what was put in: a delay that is now 1 ms and now 3 ms.
TEST(ClockFit, SaysHowFarPairsLieBesideIt) {
    std::vector<ClockPair> pairs;
    for (int n = 0; n < 1000; ++n) pairs.push_back({0.2 * n + (n % 2 ? 1e-3 : 3e-3), 0.2 * n});
    const ClockFit fit = fitClock(pairs);
    EXPECT_NEAR(fit.rms_s, 1e-3, 1e-5);
    EXPECT_NEAR(fit.max_s, 1e-3, 1e-5);
    EXPECT_NEAR(fit.sessionOf(100), 100 - 2e-3, 1e-5) << "by the delay's mean";
}

TEST(ClockFit, AnyUnitWill) {
    const std::vector<ClockPair> ms{{5000, 1}, {6000, 2}, {8000, 4}};
    EXPECT_NEAR(fitClock(ms).rate, 1e-3, 1e-12);
    EXPECT_NEAR(fitClock(ms).sessionOf(7000), 3, 1e-9);
}

TEST(ClockFit, OneMomentGivesTheOffsetAlone) {
    const std::vector<ClockPair> one{{10, 2}};
    EXPECT_EQ(fitClock(one).sessionOf(13), 5);
    const std::vector<ClockPair> same{{10, 2}, {10, 4}};
    EXPECT_EQ(fitClock(same).sessionOf(13), 6);
    EXPECT_EQ(fitClock(same).max_s, 1);
}

}  // namespace
}  // namespace bonemill
