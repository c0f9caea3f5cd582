#include <gtest/gtest.h>

#include <cmath>

#include "device_daemon/ares/ares_device/position_guard.h"

namespace bonemill {
namespace {

constexpr double kStroke = 0.15, kStep = 5e-6, kMillisecond = 1e-3;

// Returns how many periods pass until joint 4 is found that stands still while joint 3 moves 50 um in each.
int periodsUntilStuck(StuckCheck& check, Vector6d& q) {
    int periods = 0;
    while (!check.isStuck(q, kMillisecond) && periods < 1000) {
        ++periods;
        q[3] += 50e-6;
        for (const int joint : {0, 1, 2, 5}) q[joint] -= kStep;
    }
    return periods;
}

TEST(StuckCheck, FindsAJointThatStandsStillWhileAnotherMoves) {
    StuckCheck check(5e-3, kStroke);
    Vector6d q = Vector6d::Constant(0.07);
    check.restart(q);
    EXPECT_NEAR(periodsUntilStuck(check, q), 101, 1);  // 5 mm
}

TEST(StuckCheck, FindsAJointThatStopsDeadSooner) {
    StuckCheck check(5e-3, kStroke);
    Vector6d q = Vector6d::Constant(0.07);
    check.restart(q);
    for (int i = 0; i < 50; ++i) {
        EXPECT_FALSE(check.isStuck(q, kMillisecond));
        q[4] += 30e-6;
    }
    EXPECT_NEAR(periodsUntilStuck(check, q), 41, 1);  // 2 mm
}

TEST(StuckCheck, AStepNowAndThenIsEnoughToBeSound) {
    StuckCheck check(5e-3, kStroke);
    Vector6d q = Vector6d::Constant(0.02);
    check.restart(q);
    for (int i = 0; i < 2000; ++i) {
        for (const int joint : {0, 1, 2, 3, 5}) q[joint] += 50e-6;
        if (i % 90 == 0) q[4] += kStep;
        ASSERT_FALSE(check.isStuck(q, kMillisecond)) << i;
    }
}

TEST(StuckCheck, AJointAtItsStopMayStandStill) {
    for (const double stop : {0.2e-3, kStroke - 0.2e-3}) {
        StuckCheck check(5e-3, kStroke);
        Vector6d q = Vector6d::Constant(0.02);
        q[4] = stop;
        check.restart(q);
        for (int i = 0; i < 1000; ++i) {
            for (const int joint : {0, 1, 2, 3, 5}) q[joint] += 50e-6;
            ASSERT_FALSE(check.isStuck(q, kMillisecond));
        }
    }
}

double timeUntilFrozen(FrozenCheck& check, const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
    const Vector6d q = Vector6d::Constant(0.07);
    for (int i = 0; i < 1000; ++i) EXPECT_FALSE(check.isFrozen(q, before, kMillisecond));
    double time = 0;
    while (!check.isFrozen(q, after, kMillisecond) && time < 20) time += kMillisecond;
    return time;
}

TEST(FrozenCheck, FindsAReadingThatStandsStillWhileThePushChanges) {
    FrozenCheck check(0.2);
    EXPECT_NEAR(timeUntilFrozen(check, {0, 0, 0.8}, {0, 0, -0.8}), FrozenCheck::kChangedTime, 5e-3);
}

TEST(FrozenCheck, FindsAReadingThatStandsStillUnderASteadyPush) {
    FrozenCheck check(0.2);
    EXPECT_NEAR(timeUntilFrozen(check, {0, 3, 0}, {0, 3, 0}), FrozenCheck::kSteadyTime - 1, 5e-3);
}

TEST(FrozenCheck, RestsUnderALightPushAndWithTheSmallestMotion) {
    FrozenCheck check(0.2);
    Vector6d q = Vector6d::Constant(0.07);
    for (int i = 0; i < 20000; ++i) {
        ASSERT_FALSE(check.isFrozen(q, {0, i % 2 ? 0.6 : -0.6, 0}, kMillisecond));
    }
    for (int i = 0; i < 20000; ++i) {
        if (i % 90 == 0) q[i / 1000 % 6] += kStep;
        ASSERT_FALSE(check.isFrozen(q, {0, i % 2 ? 10.0 : -10.0, 0}, kMillisecond));
    }
}

TEST(HomeCheck, EverySliderMustBeWhereItIsAtHome) {
    const Vector6d q_home = Vector6d::Constant(0.075);
    Vector6d q = q_home + Vector6d::Constant(2e-3);
    EXPECT_TRUE(isAtHome(q, q_home, 3e-3));
    q[3] -= 5.5e-3;
    EXPECT_FALSE(isAtHome(q, q_home, 3e-3));
    q[3] = std::nan("");
    EXPECT_FALSE(isAtHome(q, q_home, 3e-3));
}

}  // namespace
}  // namespace bonemill
