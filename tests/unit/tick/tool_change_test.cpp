#include "haptic_server/tick/tool_change.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

constexpr double kDt = 1e-3;
constexpr double kStiffness = 6000;  // N/m

ToolChange make() {
    return {kDt, kStiffness, 0.5, 0};
}
Wrench upwards(double newton) {
    return {{0, 0, newton}, {0, 0.1 * newton, 0}};
}

TEST(ToolChange, WithoutAChangeEveryWrenchPasses) {
    ToolChange change = make();
    change.next(upwards(0), {});
    EXPECT_EQ(change.next(upwards(40), {}).force.z(), 40);
    EXPECT_TRUE(change.isOver());
}

TEST(ToolChange, TheForceGoesToTheNewOneAtTheRateAndThenPassesAgain) {
    ToolChange change = make();
    change.next(upwards(1), {});
    change.begin();
    double last = 1, last_torque = 0.1;
    int ticks = 0;
    for (; !change.isOver() && ticks < 1000; ++ticks) {
        const Wrench sent = change.next(upwards(9), {});
        EXPECT_LE(sent.force.z() - last, ToolChange::kForceRate * kDt * 1.0001);
        EXPECT_LE(sent.torque.y() - last_torque, ToolChange::kTorqueRate * kDt * 1.0001);
        last = sent.force.z(), last_torque = sent.torque.y();
    }
    EXPECT_NEAR(last, 9, 1e-9);
    EXPECT_NEAR(last_torque, 0.9, 1e-9);
    const double expected = (9 - 1) / ToolChange::kForceRate + ToolChange::kQuiet;
    EXPECT_NEAR(ticks * kDt, std::max(expected, 0.8 / ToolChange::kTorqueRate + ToolChange::kQuiet), 3e-3);
    EXPECT_EQ(change.next(upwards(30), {}).force.z(), 30);
}

// A hand that presses on meanwhile feels that at once.
TEST(ToolChange, WhatTheHandsMotionMakesIsNotHeldBack) {
    ToolChange change = make();
    Pose device;
    change.next(upwards(0), device);
    change.begin();
    const double step = 1e-4;  // m in one tick
    device.position.z() -= step;
    EXPECT_NEAR(change.next(upwards(50), device).force.z(), kStiffness * step + ToolChange::kForceRate * kDt,
                1e-9);
}

TEST(ToolChange, ABadWrenchDoesNotStay) {
    ToolChange change = make();
    change.next(upwards(2), {});
    change.begin();
    EXPECT_FALSE(change.next(upwards(std::numeric_limits<double>::quiet_NaN()), {}).isFinite());
    EXPECT_EQ(change.next(upwards(2), {}).force.z(), 2);
}

}  // namespace
}  // namespace bonemill
