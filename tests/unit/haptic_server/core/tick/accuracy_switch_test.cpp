// The accuracy changes to another preset every 50 ticks while the burr is in contact.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/core/tick/tick_choices.h"
#include "tests/support/led_tick.h"
#include "tests/unit/haptic_server/core/tick/switching_bench.h"

namespace bonemill {
namespace {

using test::SwitchingBench;
using Records = std::vector<TickRecord>;

constexpr double kTranslationStiffness = 3000;  // N/m, of both laws' coupling
constexpr double kSaturationForce = 50;         // N
constexpr double kMaxMotion = 0.5e-3;           // m per tick: 0.5 m/s

Eigen::Vector3d forceOf(const TickRecord& r) {
    return Eigen::Vector3d(r.f_hand_W);
}
Eigen::Vector3d toolOf(const TickRecord& r) {
    return Eigen::Vector3d(r.p_WT);
}
Eigen::Vector3d deviceOf(const TickRecord& r) {
    return Eigen::Vector3d(r.p_WT_device);
}

double largestForce(const Records& records) {
    double largest = 0;
    for (const TickRecord& r : records) largest = std::max(largest, forceOf(r).norm());
    return largest;
}

void expectFinite(const Records& records) {
    for (const TickRecord& r : records)
        for (const auto* values : {r.f_hand_W, r.t_hand_W, r.p_WT, r.q_WT})
            for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(std::isfinite(values[axis])) << r.tick;
}

Records withOnePreset(const std::vector<DeviceInput>& inputs, Preset preset) {
    SwitchingBench bench(presetSettings(preset));
    return test::lead(bench.tick, inputs);
}

Records withSwitching(const std::vector<DeviceInput>& inputs) {
    SwitchingBench bench;
    test::ScriptedIo io(inputs);
    bench.runSwitching(io);
    EXPECT_EQ(io.records.size(), inputs.size());
    return io.records;
}

// The hand goes 0.5 mm into the slab, and rests there through more than one round of all changes.
std::vector<DeviceInput> press(size_t approach, size_t rest) {
    auto inputs =
        test::straightPath(SwitchingBench::at(6.2e-3), SwitchingBench::at(5.5e-3).position, int(approach), 0);
    inputs.insert(inputs.end(), rest, inputs.back());
    return inputs;
}

constexpr double kQuickShare = 2;  // of the coupling's stiffness: with the relaxing spring
constexpr double kRelaxed = 0.5;   // of the force: what the relaxing spring may hold of it

// A switch leaves the tool where it is, and the new law moves it to its own equilibrium: the force goes from
// what the one preset holds to what the other one holds, beyond it only by what the relaxing spring makes of
// the way there, and in one tick no further than the two differ, with the quick stiffness.
TEST(AccuracySwitch, AHeldForceGoesFromOnePresetsToTheOthersAndNotBeyond) {
    const size_t approach = 1000, rest = 1300;
    const auto inputs = press(approach, rest);
    std::vector<Eigen::Vector3d> held;
    for (const Preset preset : kPresets) held.push_back(forceOf(withOnePreset(inputs, preset).back()));
    double low = INFINITY, high = 0, farthest = 0;
    for (const Eigen::Vector3d& a : held) {
        low = std::min(low, a.z());
        high = std::max(high, a.z());
        for (const Eigen::Vector3d& b : held) farthest = std::max(farthest, (a - b).norm());
    }
    ASSERT_GT(low, 0.1);
    ASSERT_GT(farthest, 0.1) << "presets that hold the same force show no switch";

    const Records records = withSwitching(inputs);
    expectFinite(records);
    for (size_t n = approach + SwitchingBench::kTicksPerPreset; n < records.size(); ++n) {
        const TickRecord& r = records[n];
        EXPECT_GT(r.contacts, 0u) << n;
        EXPECT_EQ(r.faults & ~kFaultOverrun, 0u) << n;
        EXPECT_GT(forceOf(r).z(), 0.9 * low) << n;
        EXPECT_LT(forceOf(r).z(), 1.15 * high) << n;
        EXPECT_LT((forceOf(r) - forceOf(records[n - 1])).norm(), 1.1 * kQuickShare * farthest) << n;
    }
}

// 50 ticks after a switch nothing is left of the settings before.
TEST(AccuracySwitch, EveryPresetSettlesWhereItDoesAlone) {
    const size_t approach = 1000;
    const auto inputs = press(approach, 1300);
    const Records records = withSwitching(inputs);
    for (const Preset preset : kPresets) {
        const double alone = forceOf(withOnePreset(inputs, preset).back()).z();
        int visits = 0;
        for (size_t n = approach + 2 * SwitchingBench::kTicksPerPreset - 1; n < records.size();
             n += SwitchingBench::kTicksPerPreset) {
            if (SwitchingBench::presetAt(n) != preset) continue;
            EXPECT_NEAR(forceOf(records[n]).z(), alone, 0.02 * alone) << presetName(preset) << ", tick " << n;
            ++visits;
        }
        EXPECT_GE(visits, 3) << presetName(preset);
    }
}

// The hand feels the coupling between tool and device, whose slope is at most its quick stiffness; so the
// force can change only as far as the two move in the tick, and the tool's speed is limited; the relaxing
// spring's part may give way, all of it when the thesis' law takes over. A force that the model remembers
// from when it was last in force, or a start from another pose, would break this.
TEST(AccuracySwitch, WhileMillingTheForceFollowsTheToolAndHasNoPeaks) {
    const auto inputs = test::straightPath(SwitchingBench::at(6.2e-3), SwitchingBench::at(3e-3).position,
                                           1500, kButtonRemove);
    const Records records = withSwitching(inputs);
    expectFinite(records);
    uint64_t removed = 0;
    for (size_t n = 1; n < records.size(); ++n) {
        const TickRecord &before = records[n - 1], &now = records[n];
        const double tool = (toolOf(now) - toolOf(before)).norm(),
                     device = (deviceOf(now) - deviceOf(before)).norm();
        EXPECT_LE(tool, kMaxMotion * (1 + 1e-9)) << n;
        // The thesis' spring k s and the saturating one, F_m tanh(k s / F_m), differ by (k s)³ / (3 F_m²)
        // at most.
        const double between_laws =
            std::pow(forceOf(before).norm(), 3) / (3 * kSaturationForce * kSaturationForce);
        EXPECT_LE((forceOf(now) - forceOf(before)).norm(),
                  kQuickShare * kTranslationStiffness * (tool + device) + between_laws +
                      kRelaxed * forceOf(before).norm() + 1e-6)
            << n;
        EXPECT_EQ(now.faults & ~uint32_t(kFaultOverrun | kFaultMotionClamped), 0u) << n;
        removed += now.removed_voxels;
    }
    EXPECT_GT(removed, 0u);
    double largest = 0;
    for (const Preset preset : kPresets)
        largest = std::max(largest, largestForce(withOnePreset(inputs, preset)));
    // The two milling shapes leave surfaces up to half a voxel apart: in the other one's hole a preset may
    // press harder than in its own, but not as if the hole were not there.
    EXPECT_LE(largestForce(records), 2 * largest);
}

}  // namespace
}  // namespace bonemill
