// What the watch takes for unrest, and what the hand's coupling does about it.
#include "haptic_server/core/tick/unrest_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/hand_coupling.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kWatchPeriod = 1e-3;

// What a handle and its coupling do at a time, s.
struct Played {
    Vector3d place = Vector3d::Zero(), force = Vector3d::Zero(), torque = Vector3d::Zero();
    bool is_touching = true;
};
using Play = std::function<Played(double t)>;

double wave(double hertz, double t) {
    return std::sin(2 * M_PI * hertz * t);
}
Vector3d circle(double hertz, double t) {
    return {std::cos(2 * M_PI * hertz * t), wave(hertz, t), 0};
}

// Returns when unrest was first seen, s; infinity: in 5 s it was not.
double seenAfter(const Play& play) {
    UnrestWatch watch(kWatchPeriod);
    for (int n = 0; n < 5000; ++n) {
        const Played now = play(n * kWatchPeriod);
        const Pose pose{now.place, Eigen::Quaterniond::Identity()};
        if (watch.add(pose, {now.force, now.torque}, now.is_touching).isAny()) return n * kWatchPeriod;
    }
    return std::numeric_limits<double>::infinity();
}

TEST(UnrestWatch, SeesWhatGoesOn) {
    const std::pair<const char*, Play> plays[] = {
        {"bounce of 15 Hz",
         [](double t) {
             return Played{{0, 0, 1e-4 * wave(15, t)}, {0, 0, 1 + wave(15, t)}, {}, wave(15, t) > -0.9};
         }},
        {"dance on the encoder",
         [](double t) {
             return Played{{}, {0, 0, 1 + 0.01 * wave(8, t)}};
         }},
        {"torque in a circle",
         [](double t) {
             return Played{{}, {0, 0, 1}, 1e-4 * circle(5, t)};
         }},
        {"growing", [](double t) {
             return Played{{}, {0, 0, 0.01 * std::exp(2 * t) * wave(20, t)}};
         }}};
    for (const auto& [name, play] : plays) EXPECT_LT(seenAfter(play), 1.1) << name;
}

TEST(UnrestWatch, LeavesAHandAlone) {
    const std::pair<const char*, Play> plays[] = {
        {"dies",
         [](double t) {
             return Played{{}, {0, 0, 1 + std::exp(-2 * t) * wave(20, t)}};
         }},
        {"too small to feel",
         [](double t) {
             return Played{{}, {0, 0, 1 + 0.005 * wave(20, t)}};
         }},
        {"presses harder and harder",
         [](double t) {
             return Played{{0, 0, -1e-3 * t}, {0, 0, 4 * t}};
         }},
        {"presses to and fro",
         [](double t) {
             return Played{{0, 0, -1e-3 * wave(1, t)}, {0, 0, 3 + 3 * wave(1, t)}};
         }},
        {"goes round in a hole",
         [](double t) {
             return Played{0.3e-3 * circle(1, t), -0.9 * circle(1, t)};
         }},
        {"slides over rough bone",
         [](double t) {
             return Played{{5e-3 * t, 0, 0}, {0, 0, 2 + 0.1 * wave(40, t)}};
         }},
        {"shakes in the air", [](double t) {
             return Played{{}, {0, 0, wave(10, t)}, {}, false};
         }}};
    for (const auto& [name, play] : plays) EXPECT_GT(seenAfter(play), 5) << name;
}

// The coupling of a device that says little, with a tool that stands still in its contact.
struct CoupledBench {
    FixedTickConfig config;
    HandCoupling coupling{config};
    double t = 0;

    CoupledBench() {
        DeviceCapabilities arm{};
        arm.abilities = kAbilityForce;
        arm.max_force = 20;
        coupling.adaptTo(arm);
    }
    // It is pressed by 1 mm and alternates by this force.
    void press(double seconds, double alternates) {
        for (int n = 0; n < int(seconds / config.dt); ++n, t += config.dt) {
            SpoStep step;
            step.X_VT = Pose{};
            step.contacts = 1;
            step.wrench_hand_V.force = {0, 0, 3 + alternates * wave(20, t)};
            coupling.takeAccount({{0, 0, -1e-3}, Eigen::Quaterniond::Identity()}, step, false);
        }
    }
    double pull() const {
        return coupling.side().gradient.translation_stiffness *
               coupling.pulledFrom({{0, 0, -1e-3}, Eigen::Quaterniond::Identity()}).position.norm();
    }
};

TEST(HandCoupling, WhatItGivesUpForRestIsNotFeltAsAJolt) {
    CoupledBench bench;
    const double before = bench.pull();
    bench.press(1.2, 0.02);
    EXPECT_LT(bench.coupling.share(), 0.9);
    EXPECT_NEAR(bench.pull(), before, 1e-9 * before);
}

TEST(HandCoupling, StiffnessComesBackAfterARestAndLaterWhereItDoesNotLast) {
    CoupledBench bench;
    const auto restUntilWhole = [&] {
        double rest = 0;
        for (; bench.coupling.share() < 1 && rest < 100; rest += 0.5) bench.press(0.5, 0);
        return rest;
    };
    bench.press(1.2, 0.02);
    const double softened = bench.coupling.share();
    bench.press(9, 0);
    EXPECT_EQ(bench.coupling.share(), softened);
    const double first = 9 + restUntilWhole();
    EXPECT_LT(first, 25);
    bench.press(1.2, 0.02);
    EXPECT_LT(bench.coupling.share(), 0.9);
    EXPECT_GT(restUntilWhole(), first + 5);
}

}  // namespace
}  // namespace bonemill
