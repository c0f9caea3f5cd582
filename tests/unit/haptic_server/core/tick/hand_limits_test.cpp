#include "haptic_server/core/tick/hand_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace bonemill {
namespace {

constexpr double kDt = 1e-3;
constexpr double kStiffness = 6000;  // N/m
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = HandLimits::kForceRate * kDt;  // N: as far as the rate goes in a tick

HandLimits make(double max_force = 100) {
    return {{.max_force = max_force, .max_torque = 10}, {kStiffness, 0.5, 0}, kDt};
}
Wrench upwards(double newton) {
    return {{0, 0, newton}, {0, 0.1 * newton, 0}};
}
// The hand is at rest in these.
Wrench sentBy(HandLimits& limits, const Wrench& computed) {
    return limits.limit({.wrench_V = computed});
}
Wrench sentUnsolved(HandLimits& limits, const Wrench& computed) {
    return limits.limit({.wrench_V = computed, .is_solved = false});
}

TEST(HandLimits, WithoutAChangeEveryWrenchPasses) {
    HandLimits limits = make();
    sentBy(limits, upwards(0));
    EXPECT_EQ(sentBy(limits, upwards(40)).force.z(), 40);
    EXPECT_TRUE(limits.isChangeOver());
    EXPECT_FALSE(limits.wasLimited());
}

TEST(HandLimits, ScaleForceAndTorqueEachByItsOwnFactor) {
    HandLimits limits({.max_force = 10, .max_torque = 1}, {}, kDt);
    const Wrench sent = sentBy(limits, {{30, 0, 40}, {0, 0.5, 0}});
    EXPECT_LT((sent.force - Eigen::Vector3d(6, 0, 8)).norm(), 1e-12);
    EXPECT_EQ(sent.torque.y(), 0.5);
    EXPECT_TRUE(limits.wasLimited());
    const Wrench turned = sentBy(limits, {{3, 0, 4}, {0, 2, 0}});
    EXPECT_EQ(turned.force, Eigen::Vector3d(3, 0, 4));
    EXPECT_NEAR(turned.torque.y(), 1, 1e-12);
    EXPECT_TRUE(limits.wasLimited());
    const Wrench small{{1, 2, 3}, {0, 0.5, 0}};
    EXPECT_EQ(sentBy(limits, small).force, small.force);
    EXPECT_FALSE(limits.wasLimited());
}

TEST(HandLimits, TheForceGoesToTheNewOneAtTheRateAndThenPassesAgain) {
    HandLimits limits = make();
    sentBy(limits, upwards(1));
    limits.beginSuddenChange();
    double last = 1, last_torque = 0.1;
    int ticks = 0;
    for (; !limits.isChangeOver() && ticks < 1000; ++ticks) {
        const Wrench sent = sentBy(limits, upwards(9));
        EXPECT_LE(sent.force.z() - last, kStep * 1.0001);
        EXPECT_LE(sent.torque.y() - last_torque, HandLimits::kTorqueRate * kDt * 1.0001);
        last = sent.force.z(), last_torque = sent.torque.y();
    }
    EXPECT_NEAR(last, 9, 1e-9);
    EXPECT_NEAR(last_torque, 0.9, 1e-9);
    const double expected = (9 - 1) / HandLimits::kForceRate + HandLimits::kQuiet;
    EXPECT_NEAR(ticks * kDt, std::max(expected, 0.8 / HandLimits::kTorqueRate + HandLimits::kQuiet), 3e-3);
    EXPECT_EQ(sentBy(limits, upwards(30)).force.z(), 30);
}

// A hand that presses on meanwhile feels that at once.
TEST(HandLimits, WhatTheHandsMotionMakesIsNotHeldBack) {
    HandLimits limits = make();
    sentBy(limits, upwards(0));
    limits.beginSuddenChange();
    const double way = 1e-4;  // m in one tick
    const Pose device{{0, 0, -way}, Eigen::Quaterniond::Identity()};
    EXPECT_NEAR(limits.limit({.wrench_V = upwards(50), .X_VT_device = device}).force.z(),
                kStiffness * way + kStep, 1e-9);
}

// What was computed beyond the limit is not what the hand comes from.
TEST(HandLimits, FromALimitedForceItGoesDownAtOnce) {
    HandLimits limits = make(10);
    EXPECT_NEAR(sentBy(limits, upwards(30)).force.z(), 10, 1e-9);
    limits.beginSuddenChange();
    for (int tick = 1; tick <= 100; ++tick)
        EXPECT_NEAR(sentBy(limits, upwards(0)).force.z(), std::max(0.0, 10 - tick * kStep), 1e-9);
}

TEST(HandLimits, AChangeIsOverAlsoAtTheNorm) {
    HandLimits limits = make(10);
    sentBy(limits, upwards(9));
    limits.beginSuddenChange();
    const Wrench far_beyond{{0, 0, 30}, {0, 1, 0}};
    for (int tick = 0; tick < 100; ++tick) EXPECT_LE(sentBy(limits, far_beyond).force.norm(), 10 + 1e-9);
    EXPECT_TRUE(limits.isChangeOver());
    EXPECT_EQ(sentBy(limits, upwards(0)).force.z(), 0);
}

// One tick is bad: the hand hardly feels it, and the force comes back along the ramp.
TEST(HandLimits, AfterAWrenchThatIsNotFiniteTheForceComesBackAlongTheRamp) {
    for (const bool is_solved : {true, false}) {
        HandLimits limits = make();
        sentBy(limits, upwards(20));
        const Wrench bad = limits.limit({.wrench_V = upwards(kNan), .is_solved = is_solved});
        EXPECT_NEAR(bad.force.z(), 20 * (1 - kDt / HandLimits::kFade), 1e-9);
        EXPECT_TRUE(limits.wasLimited());
        EXPECT_LE(sentBy(limits, upwards(80)).force.z() - bad.force.z(), kStep * 1.0001);
        EXPECT_LE(sentBy(limits, upwards(80)).force.z() - bad.force.z(), 2 * kStep * 1.0001);
    }
}

TEST(HandLimits, UnsolvedTicksFadeTheForceToNothingWhateverTheySay) {
    HandLimits limits = make();
    sentBy(limits, upwards(20));
    double last = 20;
    const int ticks = int(std::lround(HandLimits::kFade / kDt));
    for (int tick = 1; tick <= ticks; ++tick) {
        const Wrench sent = sentUnsolved(limits, upwards(tick % 2 ? 1000 : 20));
        EXPECT_NEAR(sent.force.z(), 20 * (1 - tick * kDt / HandLimits::kFade), 1e-9);
        EXPECT_NEAR(sent.torque.y(), 0.1 * sent.force.z(), 1e-9);  // the direction stays
        EXPECT_LT(sent.force.z(), last);
        last = sent.force.z();
    }
    for (int tick = 0; tick < 100; ++tick) EXPECT_LT(sentUnsolved(limits, upwards(20)).force.norm(), 1e-9);
    for (int tick = 1; tick <= 100; ++tick)
        EXPECT_NEAR(sentBy(limits, upwards(20)).force.z(), std::min(20.0, tick * kStep), 1e-9);
}

// An equilibrium that is found and lost again and again gives no pulses.
TEST(HandLimits, TicksSolvedOffAndOnOnlyLetTheForceFall) {
    HandLimits limits = make();
    double last = sentBy(limits, upwards(20)).force.z();
    for (int tick = 0; tick < 300; ++tick) {
        const double sent = tick % 3 == 2 ? sentBy(limits, upwards(20)).force.z()
                                          : sentUnsolved(limits, upwards(20)).force.z();
        EXPECT_LE(sent - last, kStep * 1.0001);
        last = sent;
    }
    EXPECT_LT(last, 5);
}

// Two springs, far beyond the norms, are led round a closed path: the force that the stretch makes must not
// depend on the turn.
TEST(HandLimits, TakeNoEnergyOutOfAClosedPath) {
    HandLimits limits({.max_force = 2, .max_torque = 0.05}, {}, kDt);
    constexpr int kSteps = 4000;
    const auto at = [](int step) {
        const double a = 2 * M_PI * step / kSteps;
        return std::pair{Eigen::Vector3d(3e-3 * std::cos(a), 0, 0), Eigen::Vector3d(0, 0.4 * std::sin(a), 0)};
    };
    const auto sentAt = [&](int step) {
        const auto [stretch, turn] = at(step);
        return sentBy(limits, {-1000 * stretch, -0.5 * turn});
    };
    double work = 0, given = 0;
    for (int step = 0; step < kSteps; ++step) {
        const Wrench a = sentAt(step), b = sentAt(step + 1);
        const double share = 0.5 * ((a.force + b.force).dot(at(step + 1).first - at(step).first) +
                                    (a.torque + b.torque).dot(at(step + 1).second - at(step).second));
        work += share;
        given += std::abs(share);
    }
    EXPECT_GT(given, 5e-3);
    EXPECT_LT(std::abs(work), 1e-3 * given);
}

TEST(HandLimits, WhatADeviceDoesNotHaveIsLeftOutAndNoLimit) {
    HandLimits limits = make();
    sentBy(limits, {{0, 0, 3}, {0, 0.5, 0}});
    limits.setDevice({.max_force = 5, .max_torque = 0}, {});
    for (int tick = 0; tick < 3; ++tick) {
        const Wrench sent = sentBy(limits, {{0, 0, 3}, {0, 0.5, 0}});
        EXPECT_EQ(sent.torque.norm(), 0);
        EXPECT_EQ(sent.force.z(), 3);
        EXPECT_FALSE(limits.wasLimited());
        EXPECT_EQ(sentUnsolved(limits, upwards(kNan)).torque.norm(), 0);
    }
    limits.setDevice({.max_force = 0, .max_torque = 0}, {});
    EXPECT_EQ(sentBy(limits, upwards(3)).force.norm(), 0);
    EXPECT_FALSE(limits.wasLimited());
}

TEST(HandLimits, AnotherDeviceChangesTheForceAtTheRateDownAndUp) {
    HandLimits limits = make();
    double last = sentBy(limits, upwards(20)).force.z();
    for (const double most : {3.0, 12.0}) {
        limits.setDevice({.max_force = most, .max_torque = 1}, {});
        for (int tick = 0; tick < 300; ++tick) {
            const double sent = sentBy(limits, upwards(20)).force.z();
            EXPECT_LE(std::abs(sent - last), kStep * 1.0001);
            last = sent;
        }
        EXPECT_NEAR(last, most, 1e-9);
    }
}

// The order of the limits matters: whatever comes before, nothing undoes the ramp of a silent device.
TEST(HandLimits, TheStaleFactorIsTheLastWord) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    HandLimits limits = make(10), whole = make(10);
    for (int tick = 0; tick < 3000; ++tick) {
        FeltStep step{.wrench_V = upwards(40 * uniform(random)), .is_solved = uniform(random) < 0.9};
        if (uniform(random) > 0.95) step.wrench_V.force.x() = kNan;
        if (uniform(random) > 0.95) {
            limits.beginSuddenChange();
            whole.beginSuddenChange();
        }
        const Wrench all = whole.limit(step);
        step.stale_factor = std::max(0.0, uniform(random));
        const Wrench sent = limits.limit(step);
        EXPECT_EQ(sent.force, step.stale_factor * all.force);
        EXPECT_EQ(sent.torque, step.stale_factor * all.torque);
    }
    for (const double nothing : {0.0, -1.0, kNan})
        EXPECT_EQ(limits.limit({.wrench_V = upwards(5), .stale_factor = nothing}).force.norm(), 0);
    EXPECT_LE(limits.limit({.wrench_V = upwards(50), .stale_factor = 7}).force.norm(), 10 + 1e-9);
}

TEST(HandLimits, NoOrderOfTicksPassesTheNorms) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double size) {
        return Eigen::Vector3d(size * Eigen::Vector3d(uniform(random), uniform(random), uniform(random)));
    };
    HandLimits limits({.max_force = 10, .max_torque = 0.5}, {kStiffness, 0.5, 0.03}, kDt);
    double most_force = 0, most_torque = 0;
    for (int tick = 0; tick < 20'000; ++tick) {
        const double size = std::pow(10, 3 * uniform(random)) * 10;
        FeltStep step{.wrench_V = {vector(size), vector(0.1 * size)},
                      .is_solved = uniform(random) < 0.95,
                      .X_VT_device = {vector(1e-3), expRotation(vector(0.1))}};
        if (uniform(random) > 0.98) step.wrench_V.torque.z() = std::numeric_limits<double>::infinity();
        if (uniform(random) > 0.9) limits.beginSuddenChange();
        const Wrench sent = limits.limit(step);
        ASSERT_TRUE(sent.isFinite());
        most_force = std::max(most_force, sent.force.norm());
        most_torque = std::max(most_torque, sent.torque.norm());
    }
    EXPECT_LE(most_force, 10 * (1 + 1e-12));
    EXPECT_LE(most_torque, 0.5 * (1 + 1e-12));
    EXPECT_GT(most_force, 9);
    EXPECT_GT(most_torque, 0.45);
}

}  // namespace
}  // namespace bonemill
