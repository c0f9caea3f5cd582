// The account at the hand's port, with springs whose energies are known.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/hand_coupling.h"

namespace bonemill {
namespace {

constexpr double kTankPeriod = 1e-3, kTankSpring = 2000, kTankDepth = 2e-3;

Pose movedBy(double x) {
    return {{x, 0, 0}, Eigen::Quaterniond::Identity()};
}
Pose turnedBy(double angle) {
    return {{0, 0, 0}, expRotation({angle, 0, 0})};
}

// The hand presses a spring that answers after `late` ticks to and fro, `times` times at 20 Hz.
void swingOn(EnergyTank& tank, int late, int times) {
    const int period = 50;
    const auto place = [&](int n) {
        return n < 0 ? 0 : kTankDepth / 2 * (1 - std::cos(2 * M_PI * n / period));
    };
    for (int n = 0; n < times * period; ++n) {
        const double x = place(n), asked = place(n - late);
        tank.add({.X_VT_device = {{x, 0, 0}, Eigen::Quaterniond::Identity()},
                  .wrench_hand_V = {{-kTankSpring * asked, 0, 0}, {0, 0, 0}},
                  .stored = kTankSpring * x * x / 2});
    }
}

EnergyTank tankOf(double damping, double delay = 0, const EnergyTank::Felt& felt = {}) {
    EnergyTank tank(kTankPeriod);
    HandleDynamics handle{};
    handle.mass = 0.1;
    handle.damping = damping;
    handle.delay = delay;
    tank.setDevice(handle, {}, {}, felt);
    return tank;
}

TEST(EnergyTank, ASlowSpringCostsLittle) {
    EnergyTank tank = tankOf(0);
    swingOn(tank, 0, 1);
    EXPECT_GT(tank.content(), 0.3 * EnergyTank::kRoom);
}

TEST(EnergyTank, ALateSpringEmptiesIt) {
    EnergyTank tank = tankOf(0);
    swingOn(tank, 3, 5);
    EXPECT_TRUE(tank.isEmpty());
    EXPECT_FALSE(tank.turnsMoreThanMoves());
}

TEST(EnergyTank, TheDevicesDampingPaysForIt) {
    // A spring that is late by 3 ticks and held for one is a damper of -K (3.5 T).
    EnergyTank tank = tankOf(1.2 * kTankSpring * 3.5 * kTankPeriod);
    swingOn(tank, 3, 5);
    EXPECT_FALSE(tank.isEmpty());
    EnergyTank weaker = tankOf(0.8 * kTankSpring * 3.5 * kTankPeriod);
    swingOn(weaker, 3, 20);
    EXPECT_TRUE(weaker.isEmpty());
}

TEST(EnergyTank, AForceThatOnlyTakesNeverEmptiesIt) {
    EnergyTank tank = tankOf(0);
    for (int n = 0; n < 5000; ++n) tank.add({movedBy(1e-5 * n), {{-3, 0, 0}, {0, 0, 0}}});
    EXPECT_EQ(tank.content(), EnergyTank::kRoom);
}

TEST(EnergyTank, TorqueCountsLikewise) {
    EnergyTank tank = tankOf(0);
    for (int n = 0; n < 100 && !tank.isEmpty(); ++n) tank.add({turnedBy(1e-3 * n), {{}, {0.1, 0, 0}}});
    EXPECT_TRUE(tank.isEmpty());
    EXPECT_TRUE(tank.turnsMoreThanMoves());
}

TEST(EnergyTank, FillingForgetsWhatWasStored) {
    EnergyTank tank = tankOf(0);
    tank.add({});
    tank.fill();
    tank.add({.stored = 1});
    EXPECT_EQ(tank.content(), EnergyTank::kRoom);
}

TEST(EnergyTank, FillingForgetsWhatWasFelt) {
    EnergyTank tank = tankOf(0, 3e-3);
    for (int n = 0; n < 20; ++n) tank.add({{}, {{10, 0, 0}, {0, 0, 0}}});
    tank.fill();
    for (int n = 0; n < 20; ++n) tank.add({movedBy(50e-6 * n)});
    EXPECT_EQ(tank.content(), EnergyTank::kRoom);
}

// It swings in the spring of a rotation whose torque the device does not give.
TEST(EnergyTank, ATorqueThatNobodyFeelsMakesNoEnergy) {
    constexpr double kTurnSpring = 0.5;  // N·m/rad
    for (const bool is_felt : {false, true}) {
        EnergyTank tank = tankOf(0, 3e-3, {.force = true, .torque = is_felt});
        for (int n = 0; n < 2000; ++n) {
            const double angle = 0.15 * std::sin(2 * M_PI * 5 * n * kTankPeriod);
            tank.add({.X_VT_device = turnedBy(angle),
                      .wrench_hand_V = {{}, {-kTurnSpring * angle, 0, 0}},
                      .stored = kTurnSpring * angle * angle / 2});
        }
        EXPECT_EQ(tank.isEmpty(), is_felt);
        EXPECT_EQ(tank.turnsMoreThanMoves(), is_felt);
    }
}

// A spindle drives the tool along, and the tool the hand: the hand gets no more than the spindle gives.
TEST(EnergyTank, WhatTheEffectsGiveWasNotMade) {
    for (const double share : {1.0, 0.5}) {
        EnergyTank tank = tankOf(0);
        for (int n = 0; n < 2000; ++n)
            tank.add({movedBy(1e-5 * n), {{3, 0, 0}, {0, 0, 0}}, 0, n > 0 ? share * 3e-5 : 0});
        EXPECT_EQ(tank.isEmpty(), share < 1);
    }
}

}  // namespace
}  // namespace bonemill
