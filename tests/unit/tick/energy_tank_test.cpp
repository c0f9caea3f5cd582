// The account at the hand's port, with springs whose energies are known.
#include "haptic_server/tick/energy_tank.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

constexpr double kTankPeriod = 1e-3, kTankSpring = 2000, kTankDepth = 2e-3;

// The hand presses a spring that answers after `late` ticks to and fro, `times` times at 20 Hz.
void swingOn(EnergyTank& tank, int late, int times) {
    const int period = 50;
    const auto place = [&](int n) {
        return n < 0 ? 0 : kTankDepth / 2 * (1 - std::cos(2 * M_PI * n / period));
    };
    for (int n = 0; n < times * period; ++n) {
        const double x = place(n), asked = place(n - late);
        tank.add({{x, 0, 0}, Eigen::Quaterniond::Identity()}, kTankSpring * x * x / 2,
                 {{-kTankSpring * asked, 0, 0}, {}});
    }
}

EnergyTank tankOf(double damping) {
    EnergyTank tank(kTankPeriod);
    HandleDynamics handle{};
    handle.mass = 0.1;
    handle.damping = damping;
    tank.setDevice(handle, {}, 1);
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
    for (int n = 0; n < 5000; ++n)
        tank.add({{1e-5 * n, 0, 0}, Eigen::Quaterniond::Identity()}, 0, {{-3, 0, 0}, {}});
    EXPECT_EQ(tank.content(), EnergyTank::kRoom);
}

TEST(EnergyTank, TorqueCountsLikewise) {
    EnergyTank tank = tankOf(0);
    for (int n = 0; n < 100 && !tank.isEmpty(); ++n)
        tank.add({{0, 0, 0}, expRotation({1e-3 * n, 0, 0})}, 0, {{}, {0.1, 0, 0}});
    EXPECT_TRUE(tank.isEmpty());
    EXPECT_TRUE(tank.turnsMoreThanMoves());
}

TEST(EnergyTank, FillingForgetsWhatWasStored) {
    EnergyTank tank = tankOf(0);
    tank.add({}, 0, {});
    tank.fill();
    tank.add({}, 1, {});
    EXPECT_EQ(tank.content(), EnergyTank::kRoom);
}

}  // namespace
}  // namespace bonemill
