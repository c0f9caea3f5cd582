// The fit of springs to a device is judged by the sampled loop itself, stepped in time.
#include "haptic_server/core/coupling/loop_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace bonemill {
namespace {

constexpr double kDt = 1e-3;
constexpr double kWall = std::numeric_limits<double>::infinity();
constexpr double kNoLimit = kWall;
constexpr LoopSprings kDefault{3000, 1, 4e-3, 1e-3};

HandleAxis handle(double mass, double damping, double delay_ticks) {
    return {mass, damping, 1 / (2 * M_PI * 1000), delay_ticks * kDt};
}

// A mass on held springs before a wall that never gives way, in small steps: by which factor per tick its
// swing grows at last.
double growthInTime(const HandleAxis& axis, const LoopSprings& springs) {
    constexpr int kParts = 200, kTicks = 1500, kLast = 500;
    const double share = kDt / (springs.relaxing_time + kDt);
    const double k_2 = springs.relaxing_share * springs.stiffness * (1 - share);
    const int late = int(std::lround(axis.delay_s / kDt * kParts));
    std::vector<double> commands;
    double x = 1e-3, v = 0, force = 0, followed = 0, middle = 0, last = 0;
    for (int tick = 0; tick < kTicks; ++tick) {
        commands.push_back(-springs.stiffness * x - k_2 * (x - followed));
        followed += share * (x - followed);
        for (int part = 0; part < kParts; ++part) {
            const int since = tick * kParts + part - late;
            const double command = since < 0 ? 0 : commands[size_t(since / kParts)];
            const double h = kDt / kParts;
            force += -std::expm1(-h / axis.amplifier_s) * (command - force);
            v = (v + h * force / axis.inertia) / (1 + h * axis.damping / axis.inertia);
            x += h * v;
        }
        const double energy = springs.stiffness * x * x + axis.inertia * v * v;
        if (tick >= kTicks - 2 * kLast && tick < kTicks - kLast) middle = std::max(middle, energy);
        if (tick >= kTicks - kLast) last = std::max(last, energy);
    }
    return std::pow(last / middle, 0.5 / kLast);
}

TEST(SampledLoop, GrowthIsThatOfTheLoopInTime) {
    for (const HandleAxis& axis :
         {handle(0.1, 0.5, 0), handle(0.1, 0.5, 1), handle(0.25, 2, 1.5), handle(0.4, 5, 3)}) {
        const double growth = growthPerTick(axis, kDefault, kWall, kDt);
        EXPECT_NEAR(growth, growthInTime(axis, kDefault), 1e-3) << axis.inertia << " " << axis.delay_s;
    }
}

TEST(SampledLoop, KnowsTheDeviceThatShookWithoutFriction) {
    EXPECT_GT(growthPerTick(handle(0.1, 0.5, 1), kDefault, kWall, kDt), 1);
    EXPECT_LT(growthPerTick(handle(0.1, 2, 1), kDefault, kWall, kDt), 1);
}

TEST(SampledLoop, InFreeAirThePlaceDoesNotMatter) {
    EXPECT_LT(growthPerTick(handle(0.1, 0.5, 1), kDefault, 0, kDt), 1);
}

LoopSprings fitted(const HandleAxis& axis, const LoopSprings& wish = kDefault, double most_quick = kNoLimit) {
    LoopFit fit(axis, wish, most_quick, kDt);
    fit.finish();
    return fit.springs();
}

TEST(LoopFit, WhatTheDeviceCarriesStaysAsItIs) {
    const LoopSprings springs = fitted(handle(0.25, 2, 1));
    EXPECT_EQ(springs.stiffness, kDefault.stiffness);
    EXPECT_EQ(springs.relaxing_share, kDefault.relaxing_share);
    EXPECT_EQ(springs.relaxing_time, kDefault.relaxing_time);
}

TEST(LoopFit, ALargerShareComesBeforeASofterWall) {
    const LoopSprings springs = fitted(handle(0.1, 0.5, 1));
    EXPECT_EQ(springs.stiffness, kDefault.stiffness);
    EXPECT_GT(springs.relaxing_share, kDefault.relaxing_share);
}

TEST(LoopFit, EveryDeviceOfTheGridComesToRest) {
    for (const double mass : {0.03, 0.1, 0.3, 1.0})
        for (const double damping : {0.05, 0.5, 5.0})
            for (const int delay : {0, 1, 2, 3}) {
                const HandleAxis axis = handle(mass, damping, delay);
                const LoopSprings springs = fitted(axis);
                EXPECT_TRUE(LoopFit::comesToRest(axis, springs, kDt))
                    << mass << " " << damping << " " << delay;
                EXPECT_GT(springs.stiffness, 200) << mass << " " << damping << " " << delay;
            }
}

TEST(LoopFit, TheDevicesOwnLimitHolds) {
    const LoopSprings springs = fitted(handle(0.1, 0.5, 1), kDefault, 4000);
    EXPECT_LE(springs.stiffness * (1 + springs.relaxing_share), 4000 * (1 + 1e-9));
}

TEST(LoopFit, AScriptWithoutARelaxingSpringGetsNone) {
    const LoopSprings springs = fitted(handle(0.1, 0.5, 1), {3000, 0, 4e-3, 1e-3});
    EXPECT_EQ(springs.relaxing_share, 0);
    EXPECT_LT(springs.stiffness, 1000);
}

TEST(LoopFit, WithoutAnInertiaTheWishIsAllThatIsKnown) {
    EXPECT_TRUE(LoopFit(handle(0, 0, 1), kDefault, kNoLimit, kDt).isDone());
    EXPECT_EQ(fitted(handle(0, 0, 1)).stiffness, kDefault.stiffness);
}

TEST(LoopFit, OddFiguresEndTheFit) {
    for (const HandleAxis& odd :
         {handle(1e-300, 1, 1), handle(1e300, 1, 1), handle(0.1, 1e300, 1), handle(0.1, 0, 1e9)}) {
        LoopFit fit(odd, kDefault, kNoLimit, kDt);
        for (int n = 0; n < 2000 && !fit.isDone(); ++n) fit.advance();
        EXPECT_TRUE(fit.isDone());
        EXPECT_TRUE(std::isfinite(fit.springs().stiffness) && fit.springs().stiffness > 0);
    }
}

}  // namespace
}  // namespace bonemill
