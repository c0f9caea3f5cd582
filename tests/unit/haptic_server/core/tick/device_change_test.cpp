// Another device is plugged in while the tick runs: what the hand feels fits it, and gets there without a
// jump.
#include <gtest/gtest.h>

#include "haptic_server/core/bone/bone_history.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

using test::ToolBench;

constexpr double kRateStep = HandLimits::kForceRate * 1e-3;  // N: as far as the rate goes in a tick

DeviceCapabilities deviceOf(double max_force, double max_torque, double max_stiffness) {
    return {.name = "device",
            .kind = uint32_t(DeviceKind::kUnknown),
            .abilities = kAbilityForce | (max_torque > 0 ? uint32_t(kAbilityTorque) : 0),
            .max_force = max_force,
            .max_torque = max_torque,
            .max_stiffness = max_stiffness,
            .max_rotation_stiffness = 0,
            .workspace_radius = 0.1};
}

constexpr double kPressed =
    test::kBenchTop + 0.2e-3;  // z of the hand's tool point: the burr gives way 0.8 mm

std::vector<DeviceInput> pressing(int ticks) {
    const Pose above = test::SwitchingBench::at(test::kBenchTop + 1.1e-3);
    return test::straightPath(above, test::SwitchingBench::at(kPressed).position, ticks, 0);
}
std::vector<DeviceInput> held(int ticks, const DeviceCapabilities* device = nullptr) {
    const Pose hand = test::SwitchingBench::at(kPressed);
    auto inputs = test::straightPath(hand, hand.position, ticks, 0);
    inputs.front().other_device = device;
    return inputs;
}
// The hand turns in the air, faster than the tool may.
std::vector<DeviceInput> turning(int ticks) {
    const Pose hand = test::SwitchingBench::at(test::kBenchTop + 2e-3);
    auto inputs = test::straightPath(hand, hand.position, ticks, 0);
    for (int n = 0; n < ticks; ++n) inputs[size_t(n)].X_WT_device.rotation = expRotation({0.01 * n, 0, 0});
    return inputs;
}
Eigen::Vector3d feltForce(const TickRecord& record) {
    return Eigen::Vector3d(record.f_hand_W);
}
double largestForceStep(const std::vector<TickRecord>& records) {
    double largest = 0;
    for (size_t n = 1; n < records.size(); ++n)
        largest = std::max(largest, (feltForce(records[n]) - feltForce(records[n - 1])).norm());
    return largest;
}

TEST(DeviceChange, InContactTheForceGoesToWhatTheDeviceGivesAtALimitedRate) {
    const DeviceCapabilities arm = deviceOf(3, 0, 500), strong = deviceOf(40, 2, 0);
    for (const Preset preset : kPresets) {
        ToolBench bench(1, presetSettings(preset));
        bench.run(pressing(300));
        const TickRecord before = bench.run(held(400)).back();
        ASSERT_GT(feltForce(before).norm(), 1) << presetName(preset);
        const auto weak = bench.run(held(400, &arm));
        EXPECT_LE((feltForce(weak.front()) - feltForce(before)).norm(), 1.001 * kRateStep);
        EXPECT_LE(largestForceStep(weak), 1.001 * kRateStep) << presetName(preset);
        EXPECT_LE(feltForce(weak.back()).norm(), 3 * (1 + 1e-9)) << presetName(preset);
        EXPECT_GT(feltForce(weak.back()).norm(), 0.1) << presetName(preset);
        const auto again = bench.run(held(400, &strong));
        EXPECT_LE((feltForce(again.front()) - feltForce(weak.back())).norm(), 1.001 * kRateStep);
        EXPECT_LE(largestForceStep(again), 1.001 * kRateStep) << presetName(preset);
        EXPECT_NEAR(feltForce(again.back()).norm(), feltForce(before).norm(), 0.05 * feltForce(before).norm())
            << presetName(preset);
    }
}

TEST(DeviceChange, ADeviceWithoutTorqueIsSentNoneAtOnceAndIsNotCalledLimited) {
    ToolBench bench(1);
    const DeviceCapabilities arm = deviceOf(30, 0, 0);
    auto turn = turning(20);
    EXPECT_GT(Eigen::Vector3d(bench.run(turn).back().t_hand_W).norm(), 1e-3);
    turn.front().other_device = &arm;
    for (const TickRecord& record : bench.run(turn)) {
        EXPECT_EQ(Eigen::Vector3d(record.t_hand_W).norm(), 0);
        EXPECT_FALSE(record.faults & kFaultForceClamped);
    }
}

// The springs of both laws give way, in the lasting pull, by the force over the device's stiffness.
TEST(DeviceChange, TheCouplingIsNoStifferThanTheDeviceHolds) {
    const DeviceCapabilities soft = deviceOf(30, 0, 400);
    for (const Preset preset : kPresets) {
        ToolBench bench(1, presetSettings(preset));
        bench.run(pressing(300));
        const TickRecord last = bench.run(held(600, &soft)).back();
        const double stretch = (Eigen::Vector3d(last.p_WT) - Eigen::Vector3d(last.p_WT_device)).norm();
        EXPECT_LE(feltForce(last).norm(), 1.001 * 400 * stretch) << presetName(preset);
    }
}

// The fit goes on beside the ticks.
TEST(DeviceChange, ADeviceThatSaysWhatItIsLikeIsHeldByWhatItCarries) {
    constexpr int kFitTicks = 500;
    DeviceCapabilities device = deviceOf(40, 1, 0);
    device.handle = test::kSteadyHandle;
    ToolBench bench(1);
    const TickRecord usual = bench.run(held(kFitTicks, &device)).back();
    EXPECT_EQ(usual.coupling_share, 1);
    EXPECT_EQ(usual.rotation_share, 1);
    device.handle.angular_damping = 1e-4;
    const TickRecord light = bench.run(held(kFitTicks, &device)).back();
    EXPECT_EQ(light.coupling_share, 1);
    EXPECT_LT(light.rotation_share, 0.5);
    EXPECT_GT(light.rotation_share, 0.001);
}

// A tool chosen later is pulled with no more, either.
TEST(DeviceChange, TheLimitOutlivesAChangeOfTheTool) {
    ToolBench bench(0);
    const DeviceCapabilities arm = deviceOf(2, 0, 0);
    bench.run(pressing(300));
    bench.run(held(300, &arm));
    bench.tools.choose(2);
    for (const TickRecord& record : bench.run(held(400))) EXPECT_LE(feltForce(record).norm(), 2 * (1 + 1e-9));
}

// The bone goes where the burr mills, faster than this hand.
TEST(DeviceState, OnlyAnEngagedDeviceMillsAndEveryOtherOneFeels) {
    for (uint32_t state = 0; state < kSafetyStateCount; ++state) {
        ToolBench bench(1);
        auto inputs = pressing(200);
        for (DeviceInput& input : inputs) {
            input.device.state = state;
            input.buttons = kButtonRemove;
        }
        const auto records = bench.run(inputs);
        EXPECT_EQ(bench.history.missingVoxels() > 0, SafetyState(state) == SafetyState::kEngaged) << state;
        EXPECT_EQ(records.back().contacts == 0, SafetyState(state) == SafetyState::kEngaged) << state;
        EXPECT_EQ(records.back().device.state, state);
    }
}

TEST(DeviceState, FaultsOfTheWayToTheTickAreInItsRecord) {
    ToolBench bench(1);
    auto inputs = held(2);
    inputs[0].faults = kFaultImplausibleDevice | kFaultEarlySamples;
    const auto records = bench.run(inputs);
    EXPECT_EQ(records[0].faults & inputs[0].faults, inputs[0].faults);
    EXPECT_FALSE(records[1].faults & inputs[0].faults);
}

// The tool's motion is the handle's times the scale, and the power at the handle that at the tool over it.
TEST(WorkspaceScale, TheHandGetsTheToolsForceAndItsTorqueOverTheScale) {
    const auto torqueAt = [](double scale) {
        ToolBench bench(1);
        TickConfig config = test::millingConfig();
        config.hand_space = HandSpace(scale);
        HapticTick tick(config, {bench.bone}, {bench.tools, bench.accuracy});
        return test::lead(tick, turning(20)).back();
    };
    const TickRecord same = torqueAt(1), larger = torqueAt(4);
    EXPECT_EQ(feltForce(larger), feltForce(same));
    EXPECT_GT(Eigen::Vector3d(same.t_hand_W).norm(), 1e-6);
    EXPECT_LT((4 * Eigen::Vector3d(larger.t_hand_W) - Eigen::Vector3d(same.t_hand_W)).norm(), 1e-15);
}

}  // namespace
}  // namespace bonemill
