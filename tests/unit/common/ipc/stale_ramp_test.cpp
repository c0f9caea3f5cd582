#include "common/ipc/stale_ramp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bonemill {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr StaleRampConfig kConfig{
    .stale_after_ns = 20 * kMs, .ramp_down_ns = 50 * kMs, .ramp_up_ns = 300 * kMs};

// The ramp has been fed fresh stamps until it is fully up; its clock is simulated, one tick per ms.
struct SimulatedRun {
    StaleRamp ramp{kConfig};
    int64_t now_ns = 1'000'000 * kMs;
    int64_t stamp_ns = 0;

    double tick(bool is_fresh) {
        now_ns += kMs;
        if (is_fresh) stamp_ns = now_ns;
        return ramp.update(now_ns, stamp_ns);
    }
    void ticks(int count, bool is_fresh) {
        for (int i = 0; i < count; ++i) tick(is_fresh);
    }
};

TEST(StaleRamp, startsAtZeroAndFadesIn) {
    SimulatedRun run;
    EXPECT_EQ(run.ramp.factor(), 0.0);
    EXPECT_EQ(run.tick(false), 0.0);
    EXPECT_TRUE(run.ramp.isStale());
    double last = run.tick(true);
    EXPECT_EQ(last, 0.0);
    EXPECT_FALSE(run.ramp.isStale());
    for (int i = 1; i <= 300; ++i) {
        const double factor = run.tick(true);
        EXPECT_GT(factor, last);
        last = factor;
    }
    EXPECT_EQ(last, 1.0);
}

TEST(StaleRamp, fallsLinearlyOnceTheStampIsTooOld) {
    SimulatedRun run;
    run.ticks(400, true);
    ASSERT_EQ(run.ramp.factor(), 1.0);
    for (int age_ms = 1; age_ms <= 20; ++age_ms) EXPECT_EQ(run.tick(false), 1.0) << age_ms;
    EXPECT_TRUE(run.ramp.isStale());  // at exactly 20 ms
    for (int ms = 1; ms <= 50; ++ms) EXPECT_NEAR(run.tick(false), 1.0 - ms / 50.0, 1e-12);
    EXPECT_EQ(run.tick(false), 0.0);
}

TEST(StaleRamp, aPauseOfThisSideCountsAsSilenceToo) {
    SimulatedRun run;
    run.ticks(400, true);
    run.now_ns += 44 * kMs;
    EXPECT_NEAR(run.tick(false), 1.0 - 25.0 / 50.0, 1e-12);  // 45 ms old: 25 ms into the ramp
}

TEST(StaleRamp, recoversSmoothlyFromWhereItWas) {
    SimulatedRun run;
    run.ticks(400, true);
    run.ticks(20 + 25, false);
    ASSERT_NEAR(run.ramp.factor(), 0.5, 1e-12);
    double last = run.tick(true);
    EXPECT_NEAR(last, 0.5, 1e-12);
    double largest_step = 0;
    const double first_step = run.tick(true) - last;
    for (int i = 0; i < 298; ++i) {
        last = run.ramp.factor();
        largest_step = std::max(largest_step, run.tick(true) - last);
    }
    last = run.ramp.factor();
    const double last_step = run.tick(true) - last;
    EXPECT_GT(last_step, 0);
    EXPECT_EQ(run.ramp.factor(), 1.0);
    EXPECT_LT(first_step, 0.1 * largest_step);  // no kink where it begins and ends
    EXPECT_LT(last_step, 0.1 * largest_step);
}

TEST(StaleRamp, isContinuousWhateverThePeerDoes) {
    std::mt19937_64 random(3);
    SimulatedRun run;
    double last = 0;
    const double steepest = 1.0 / 50 + 1e-9;  // ramp down, per ms
    for (int phase = 0; phase < 300; ++phase) {
        const bool is_fresh = random() % 2;
        const int count = int(random() % 100);
        for (int i = 0; i < count; ++i) {
            if (random() % 50 == 0) run.stamp_ns = int64_t(random());  // garbage
            const double factor = run.tick(is_fresh);
            ASSERT_GE(factor, 0.0);
            ASSERT_LE(factor, 1.0);
            ASSERT_LE(std::abs(factor - last), steepest);
            last = factor;
        }
    }
}

TEST(StaleRamp, anyStampIsAccepted) {
    for (const int64_t stamp : {INT64_MIN, int64_t(-1), int64_t(0), INT64_MAX}) {
        SimulatedRun run;
        run.ticks(400, true);
        run.stamp_ns = stamp;
        run.ticks(60, false);
        EXPECT_EQ(run.ramp.factor(), 0.0) << stamp;
        EXPECT_TRUE(run.ramp.isStale());
    }
}

TEST(StaleRamp, aStampSlightlyAheadIsFresh) {
    SimulatedRun run;
    run.ticks(400, true);
    run.stamp_ns = run.now_ns + 2 * kMs;
    EXPECT_EQ(run.tick(false), 1.0);
    EXPECT_FALSE(run.ramp.isStale());
}

TEST(StaleRamp, zeroDurationsSwitchAtOnce) {
    StaleRamp ramp({.stale_after_ns = kMs, .ramp_down_ns = 0, .ramp_up_ns = 0});
    EXPECT_EQ(ramp.update(100 * kMs, 100 * kMs), 1.0);
    EXPECT_EQ(ramp.update(102 * kMs, 100 * kMs), 0.0);
}

}  // namespace
}  // namespace bonemill
