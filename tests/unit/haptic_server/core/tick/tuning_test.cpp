// The contact law is tuned while the tick runs: the hand gets what was tuned, and without a jump.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "haptic_server/core/bone/bone_history.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

using test::ToolBench;
using Change = std::function<void(TickTuning&)>;
using Records = std::vector<TickRecord>;

constexpr double kRateStep = HandLimits::kForceRate * 1e-3;         // N: as far as the rate goes in a tick
constexpr double kTorqueRateStep = HandLimits::kTorqueRate * 1e-3;  // N·m
constexpr double kPressed = test::kBenchTop + 0.5e-3;  // z of the hand: the burr gives way 0.5 mm

std::vector<DeviceInput> pressing(int ticks) {
    const Pose above = test::SwitchingBench::at(test::kBenchTop + 1.1e-3);
    return test::straightPath(above, test::SwitchingBench::at(kPressed).position, ticks, 0);
}
std::vector<DeviceInput> held(int ticks) {
    const Pose hand = test::SwitchingBench::at(kPressed);
    return test::straightPath(hand, hand.position, ticks, 0);
}
Eigen::Vector3d forceOf(const TickRecord& record) {
    return Eigen::Vector3d(record.f_hand_W);
}
void expectNoJump(const TickRecord& before, const Records& records, const std::string& what) {
    const TickRecord* last = &before;
    for (const TickRecord& record : records) {
        ASSERT_LE((forceOf(record) - forceOf(*last)).norm(), 1.001 * kRateStep) << what << ' ' << record.tick;
        ASSERT_LE((Eigen::Vector3d(record.t_hand_W) - Eigen::Vector3d(last->t_hand_W)).norm(),
                  1.001 * kTorqueRateStep)
            << what << ' ' << record.tick;
        last = &record;
    }
}

const std::pair<const char*, Change> kChanges[] = {
    {"stiffer",
     [](TickTuning& t) { t.thesis.translation_stiffness *= 3, t.gradient.translation_stiffness *= 3; }},
    {"softer",
     [](TickTuning& t) { t.thesis.translation_stiffness /= 4, t.gradient.translation_stiffness /= 4; }},
    {"turning softer",
     [](TickTuning& t) { t.thesis.rotation_stiffness /= 4, t.gradient.rotation_stiffness /= 4; }},
    {"damped", [](TickTuning& t) { t.gradient.damping_time *= 5; }},
    {"relaxing", [](TickTuning& t) { t.gradient.relaxing_share = 3; }},
    {"soft bone", [](TickTuning& t) { t.contact.stiffness_per_area /= 50; }},
    {"weak", [](TickTuning& t) { t.hand.max_force = 0.3; }},
    {"all", [](TickTuning& t) {
         t.thesis.translation_stiffness /= 2, t.gradient.translation_stiffness /= 2;
         t.contact.stiffness_per_area /= 10, t.hand.max_force = 0.5, t.hand.max_torque = 0.01;
     }}};

TEST(Tuning, InContactTheForceGoesToWhatWasTunedAtALimitedRateAndBack) {
    for (const Preset preset : kPresets) {
        for (const auto& [name, change] : kChanges) {
            const std::string what = std::string(presetName(preset)) + ", " + name;
            ToolBench bench(1, presetSettings(preset));
            bench.run(pressing(300));
            const TickRecord before = bench.run(held(600)).back();
            ASSERT_GT(forceOf(before).norm(), 0.5) << what;
            bench.tune(change);
            const Records tuned = bench.run(held(700));
            expectNoJump(before, tuned, what);

            // As if it had been so from the beginning.
            ToolBench alone(1, presetSettings(preset));
            alone.tune(change);
            alone.run(pressing(300));
            const double wanted = forceOf(alone.run(held(1300)).back()).norm();
            EXPECT_NEAR(forceOf(tuned.back()).norm(), wanted, 0.02 * wanted + 1e-3) << what;

            bench.tunings.choose(TuningSwitch::kOfScene);
            const Records back = bench.run(held(700));
            expectNoJump(tuned.back(), back, what);
            EXPECT_NEAR((forceOf(back.back()) - forceOf(before)).norm(), 0, 0.02 * forceOf(before).norm())
                << what;
        }
    }
}

TEST(Tuning, WhatWasTunedIsFelt) {
    ToolBench bench(1);
    bench.run(pressing(300));
    const double before = forceOf(bench.run(held(600)).back()).norm();
    bench.tune(kChanges[1].second);
    const double softer = forceOf(bench.run(held(700)).back()).norm();
    EXPECT_LT(softer, 0.6 * before);
    bench.tune(kChanges[6].second);
    EXPECT_NEAR(forceOf(bench.run(held(700)).back()).norm(), 0.3, 1e-6);
}

// A burr that the wall carries less for is pulled less: the tool's saturation follows the contact's
// stiffness.
TEST(Tuning, TheToolInUseIsPulledWithWhatWasTunedForIt) {
    ToolBench bench(1);
    bench.run(pressing(300));
    const Change weak_burrs = [](TickTuning& t) { t.saturation_forces = {1, 0.4, 2}; };
    bench.tune(weak_burrs);
    EXPECT_LE(forceOf(bench.run(held(700)).back()).norm(), 0.4 * (1 + 1e-9));
    bench.tools.choose(2);
    const double large = forceOf(bench.run(held(700)).back()).norm();
    EXPECT_GT(large, 0.8);
    EXPECT_LE(large, 2 * (1 + 1e-9));
}

bool areSame(const Records& a, const Records& b) {
    if (a.size() != b.size()) return false;
    for (size_t n = 0; n < a.size(); ++n)
        if (std::memcmp(a[n].f_hand_W, b[n].f_hand_W, sizeof a[n].f_hand_W) != 0 ||
            std::memcmp(a[n].p_WT, b[n].p_WT, sizeof a[n].p_WT) != 0 ||
            a[n].removed_voxels != b[n].removed_voxels)
            return false;
    return true;
}

// A replay has no one who chooses: it has the recorded numbers.
TEST(Tuning, TheRecordedNumbersGiveTheSameBits) {
    const auto path = pressing(300);
    ToolBench live(1);
    Records recorded = live.run(path);
    for (const auto& [name, change] : kChanges) {
        live.tune(change);
        const Records more = live.run(held(100));
        recorded.insert(recorded.end(), more.begin(), more.end());
    }
    EXPECT_EQ(recorded.front().input.decisions.tuning, 0u);
    EXPECT_EQ(recorded.back().input.decisions.tuning, std::size(kChanges));

    auto inputs = path;
    for (size_t n = 0; n < std::size(kChanges); ++n) {
        const auto more = held(100);
        inputs.insert(inputs.end(), more.begin(), more.end());
    }
    ASSERT_EQ(inputs.size(), recorded.size());
    for (size_t n = 0; n < inputs.size(); ++n) inputs[n].decisions = &recorded[n].input.decisions;
    ToolBench again(1), untuned(1);
    for (const auto& [name, change] : kChanges) again.tunings.add(ToolBench::tuned(change));
    EXPECT_TRUE(areSame(again.run(inputs), recorded));
    for (DeviceInput& input : inputs) input.decisions = nullptr;
    EXPECT_FALSE(areSame(untuned.run(inputs), recorded)) << "it makes a difference";
}

TEST(Tuning, ThereIsRoomForManyAndNotForMore) {
    TuningSwitch tunings(ToolBench::tuned([](TickTuning&) {}));
    for (uint32_t n = 1; n <= TuningSwitch::kMost; ++n)
        ASSERT_EQ(tunings.add(ToolBench::tuned([&](TickTuning& t) { t.hand.max_force = n; })), n);
    EXPECT_EQ(tunings.add(ToolBench::tuned([](TickTuning&) {})), TuningSwitch::kOfScene);
    tunings.choose(TuningSwitch::kMost);
    EXPECT_EQ(tunings[tunings.chosen()].hand.max_force, TuningSwitch::kMost);
}

}  // namespace
}  // namespace bonemill
