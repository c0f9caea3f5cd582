#include "device_daemon/control/safety/wrench_limiter.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace bonemill {
namespace {

constexpr double kDt = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Wrench settled(WrenchLimiter& limiter, const Wrench& wanted) {
    Wrench given;
    for (int i = 0; i < 1000; ++i) given = limiter.limit(wanted, 1, kDt);
    return given;
}

TEST(WrenchLimiter, PassesWhatIsWithinAllLimits) {
    WrenchLimiter limiter;
    const Wrench wanted{{1, 2, 3}, {0.01, 0.02, -0.03}};
    const Wrench given = settled(limiter, wanted);
    EXPECT_EQ(given.force, wanted.force);
    EXPECT_EQ(given.torque, wanted.torque);
    EXPECT_EQ(limiter.events(), kWrenchNotLimited);
}

TEST(WrenchLimiter, ScalesForceAndTorqueApartAndKeepsTheirDirections) {
    WrenchLimiter limiter(
        {.max_force = 10, .max_torque = 0.2, .max_force_rate = 1e9, .max_torque_rate = 1e9});
    const Wrench wanted{{30, 40, 0}, {0.1, 0, 0}};
    const Wrench given = limiter.limit(wanted, 1, kDt);
    EXPECT_LT((given.force - Eigen::Vector3d(6, 8, 0)).norm(), 1e-12);
    EXPECT_EQ(given.torque, wanted.torque);  // the force takes nothing of the torque
    EXPECT_TRUE(limiter.events() & kWrenchClamped);
    const Wrench turned = limiter.limit({{0, 0, 1}, {0, 3, 4}}, 1, kDt);
    EXPECT_LT((turned.torque - Eigen::Vector3d(0, 0.12, 0.16)).norm(), 1e-12);
    EXPECT_EQ(turned.force, Eigen::Vector3d(0, 0, 1));
}

// A device that gives no torque has a largest torque of 0.
TEST(WrenchLimiter, WithoutTorqueTheForceStays) {
    WrenchLimiter limiter({.max_force = 3, .max_torque = 0});
    const Wrench given = settled(limiter, {{0, 0, 2}, {1, 1, 1}});
    EXPECT_EQ(given.force, Eigen::Vector3d(0, 0, 2));
    EXPECT_EQ(given.torque, Eigen::Vector3d::Zero());
}

TEST(WrenchLimiter, NeverChangesFasterThanItsRates) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    const WrenchLimits limits;
    WrenchLimiter limiter(limits);
    Wrench before;
    for (int i = 0; i < 20000; ++i) {
        const double size = i % 3 ? 300 : 3;
        const Wrench wanted{size * Eigen::Vector3d(any(random), any(random), any(random)),
                            size / 50 * Eigen::Vector3d(any(random), any(random), any(random))};
        const Wrench given = limiter.limit(i % 17 ? wanted : Wrench{{kNan, 0, 0}, {0, 0, 0}}, 1, kDt);
        EXPECT_LE((given.force - before.force).norm(), limits.max_force_rate * kDt * (1 + 1e-12));
        EXPECT_LE((given.torque - before.torque).norm(), limits.max_torque_rate * kDt * (1 + 1e-12));
        EXPECT_LE(given.force.norm(), limits.max_force * (1 + 1e-12));
        EXPECT_LE(given.torque.norm(), limits.max_torque * (1 + 1e-12));
        before = given;
    }
}

TEST(WrenchLimiter, ForgedCommandsStayWithinTheDevice) {
    WrenchLimiter limiter;
    const Wrench given = settled(limiter, {{1e300, -1e300, 1e300}, {5.7, 0, 300}});
    EXPECT_NEAR(given.force.norm(), 50, 1e-9);
    EXPECT_NEAR(given.torque.norm(), 1, 1e-9);
}

TEST(WrenchLimiter, WhatIsNotFiniteGoesToZeroByTheRate) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        WrenchLimiter limiter;
        settled(limiter, {{0, 0, 20}, {0.1, 0, 0}});
        const Wrench first = limiter.limit({{bad, 0, 0}, {0, 0, 0}}, 1, kDt);
        EXPECT_NEAR(first.force.z(), 17, 1e-9);
        EXPECT_TRUE(limiter.events() & kWrenchNotFinite);
        EXPECT_EQ(settled(limiter, {{0, bad, 0}, {0, 0, bad}}).force, Eigen::Vector3d::Zero());
    }
}

TEST(WrenchLimiter, FromFarBeyondTheNormsItComesBackAtOnce) {
    WrenchLimiter limiter;
    settled(limiter, {{0, 0, 5000}, {0, 0, 0}});
    const Wrench given = limiter.limit({}, 1, kDt);
    EXPECT_NEAR(given.force.z(), 50 - 3, 1e-9);
}

TEST(WrenchLimiter, TheFactorComesLastAndOddTimesChangeNothing) {
    WrenchLimiter limiter;
    settled(limiter, {{0, 0, 20}, {0, 0, 0}});
    EXPECT_NEAR(limiter.limit({{0, 0, 20}, {0, 0, 0}}, 0.25, kDt).force.z(), 5, 1e-12);
    EXPECT_EQ(limiter.limit({{0, 0, 20}, {0, 0, 0}}, 0, kDt).force, Eigen::Vector3d::Zero());
    EXPECT_EQ(limiter.limit({{0, 0, 20}, {0, 0, 0}}, kNan, kDt).force, Eigen::Vector3d::Zero());
    for (const double dt : {0.0, -1.0, kNan})
        EXPECT_NEAR(limiter.limit({{0, 0, -20}, {0, 0, 0}}, 2, dt).force.z(), 20, 1e-12) << dt;
}

}  // namespace
}  // namespace bonemill
