#include "haptic_server/tick/sudden_change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace bonemill {
namespace {

constexpr double kDt = 1e-3;
constexpr double kStiffness = 6000;  // N/m

SuddenChange make(double max_force = 100) {
    CouplingConfig limits;
    limits.max_force = max_force;
    limits.max_torque = 10;
    return {limits, kDt, kStiffness, 0.5, 0};
}
Wrench upwards(double newton) {
    return {{0, 0, newton}, {0, 0.1 * newton, 0}};
}
Wrench sentBy(SuddenChange& change, Wrench computed, const Pose& device = {}) {
    change.limit(computed, device);
    return computed;
}

TEST(SuddenChange, WithoutAChangeEveryWrenchPasses) {
    SuddenChange change = make();
    sentBy(change, upwards(0));
    EXPECT_EQ(sentBy(change, upwards(40)).force.z(), 40);
    EXPECT_TRUE(change.isOver());
}

TEST(SuddenChange, TheForceGoesToTheNewOneAtTheRateAndThenPassesAgain) {
    SuddenChange change = make();
    sentBy(change, upwards(1));
    change.begin();
    double last = 1, last_torque = 0.1;
    int ticks = 0;
    for (; !change.isOver() && ticks < 1000; ++ticks) {
        const Wrench sent = sentBy(change, upwards(9));
        EXPECT_LE(sent.force.z() - last, SuddenChange::kForceRate * kDt * 1.0001);
        EXPECT_LE(sent.torque.y() - last_torque, SuddenChange::kTorqueRate * kDt * 1.0001);
        last = sent.force.z(), last_torque = sent.torque.y();
    }
    EXPECT_NEAR(last, 9, 1e-9);
    EXPECT_NEAR(last_torque, 0.9, 1e-9);
    const double expected = (9 - 1) / SuddenChange::kForceRate + SuddenChange::kQuiet;
    EXPECT_NEAR(ticks * kDt, std::max(expected, 0.8 / SuddenChange::kTorqueRate + SuddenChange::kQuiet),
                3e-3);
    EXPECT_EQ(sentBy(change, upwards(30)).force.z(), 30);
}

// A hand that presses on meanwhile feels that at once.
TEST(SuddenChange, WhatTheHandsMotionMakesIsNotHeldBack) {
    SuddenChange change = make();
    Pose device;
    sentBy(change, upwards(0), device);
    change.begin();
    const double step = 1e-4;  // m in one tick
    device.position.z() -= step;
    EXPECT_NEAR(sentBy(change, upwards(50), device).force.z(),
                kStiffness * step + SuddenChange::kForceRate * kDt, 1e-9);
}

TEST(SuddenChange, ABadWrenchIsZeroAtOnceAndDoesNotStay) {
    SuddenChange change = make();
    sentBy(change, upwards(2));
    change.begin();
    EXPECT_EQ(sentBy(change, upwards(std::numeric_limits<double>::quiet_NaN())).force.norm(), 0);
    EXPECT_NEAR(sentBy(change, upwards(2)).force.z(), SuddenChange::kForceRate * kDt, 1e-9);
}

// What was computed beyond the limit is not what the hand comes from.
TEST(SuddenChange, FromALimitedForceItGoesDownAtOnce) {
    SuddenChange change = make(10);
    Wrench wrench = upwards(30);
    EXPECT_TRUE(change.limit(wrench, {}));
    EXPECT_NEAR(wrench.force.z(), 10, 1e-9);
    change.begin();
    for (int tick = 1; tick <= 100; ++tick)
        EXPECT_NEAR(sentBy(change, upwards(0)).force.z(),
                    std::max(0.0, 10 - tick * SuddenChange::kForceRate * kDt), 1e-9);
}

TEST(SuddenChange, IsOverAlsoAtTheLimit) {
    SuddenChange change = make(10);
    sentBy(change, upwards(9));
    change.begin();
    for (int tick = 0; tick < 100; ++tick) EXPECT_LE(sentBy(change, upwards(30)).force.norm(), 10 + 1e-9);
    EXPECT_TRUE(change.isOver());
    EXPECT_EQ(sentBy(change, upwards(0)).force.z(), 0);
}

}  // namespace
}  // namespace bonemill
