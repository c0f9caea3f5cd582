#include "device_daemon/bridges/bridge/force_gate.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill::bridge {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 1e-3;
constexpr WrenchNorms kNorms{4, 0.2};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Wrench force(double x, double y, double z) {
    return {Vector3d(x, y, z), Vector3d::Zero()};
}

TEST(ForceGate, OpensAndClosesIn20Milliseconds) {
    ForceGate gate(kNorms);
    EXPECT_TRUE(gate.isClosed());
    double before = 0;
    for (int i = 0; i < 20; ++i) {
        const double now = gate.step(force(2, 0, 0), kPeriod).force.x();
        EXPECT_NEAR(now - before, 0.1, 1e-12);
        before = now;
    }
    EXPECT_NEAR(before, 2, 1e-12);
    for (int i = 0; i < 20; ++i) {
        const double now = gate.step(std::nullopt, kPeriod).force.x();
        EXPECT_NEAR(before - now, 0.1, 1e-12);
        before = now;
    }
    EXPECT_EQ(gate.step(std::nullopt, kPeriod).force, Vector3d::Zero());
    EXPECT_TRUE(gate.isClosed());
}

TEST(ForceGate, ALongPeriodClosesItAtOnceAndATimeThatRunsBackDoesNothing) {
    ForceGate gate(kNorms);
    EXPECT_NEAR(gate.step(force(0, 3, 0), 1).force.y(), 3, 1e-12);
    EXPECT_NEAR(gate.step(std::nullopt, -1).force.y(), 3, 1e-12);
    EXPECT_EQ(gate.step(std::nullopt, 1).force, Vector3d::Zero());
}

TEST(ForceGate, KeepsTheArmsNorms) {
    ForceGate gate(kNorms);
    const Wrench given = gate.step(Wrench{Vector3d(30, -40, 0), Vector3d(0, 0, 9)}, 1);
    EXPECT_NEAR((given.force - Vector3d(2.4, -3.2, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((given.torque - Vector3d(0, 0, 0.2)).norm(), 0, 1e-12);
}

TEST(ForceGate, WhatIsNotFiniteIsNoWish) {
    ForceGate gate(kNorms);
    gate.step(force(2, 0, 0), 1);
    EXPECT_NEAR(gate.step(force(kNaN, 0, 0), kPeriod).force.x(), 1.9, 1e-12) << "it fades";
}

}  // namespace
}  // namespace bonemill::bridge
