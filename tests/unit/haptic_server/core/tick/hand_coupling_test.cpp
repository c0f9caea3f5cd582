// What the hand's coupling gives up of its stiffness, and what costs it none, in whole ticks with a device
// that says what it is like.
#include "haptic_server/core/tick/hand_coupling.h"

#include <gtest/gtest.h>

#include "haptic_server/core/tick/fixed_tick.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

using test::ToolBench;

constexpr double kUpHere = test::kBenchTop + 0.2e-3;  // z of a hand that presses a burr of 1 mm

DeviceCapabilities steadyArm() {
    DeviceCapabilities arm{.name = "arm",
                           .kind = uint32_t(DeviceKind::kUnknown),
                           .abilities = kAbilityForce | kAbilityTorque,
                           .max_force = 40,
                           .max_torque = 1,
                           .max_stiffness = 0,
                           .max_rotation_stiffness = 0,
                           .workspace_radius = 0.1};
    arm.handle = test::kSteadyHandle;
    return arm;
}

std::vector<DeviceInput> heldAt(const Pose& hand, int ticks) {
    return test::straightPath(hand, hand.position, ticks, 0);
}

double leastShare(const std::vector<TickRecord>& records) {
    double least = 1;
    for (const TickRecord& record : records) least = std::min(least, record.coupling_share);
    return least;
}

TEST(HandCoupling, AHandThatIsTakenElsewhereCostsNoStiffness) {
    ToolBench bench(1);
    const DeviceCapabilities arm = steadyArm();
    const Pose hand = test::SwitchingBench::at(kUpHere);
    auto inputs =
        test::straightPath(test::SwitchingBench::at(test::kBenchTop + 1.1e-3), hand.position, 300, 0);
    inputs.front().other_device = &arm;
    ASSERT_EQ(leastShare(bench.run(inputs)), 1);
    const auto records = bench.run(heldAt({hand.position + Eigen::Vector3d(5e-3, 0, 0), hand.rotation}, 500));
    EXPECT_TRUE(records.front().faults & kFaultBadDevicePose) << "it is a jump";
    EXPECT_EQ(leastShare(records), 1);
}

// A burr that turns and hardly cuts is driven along the bone by its spindle.
TEST(HandCoupling, ASpindleThatDrivesTheToolCostsNoStiffness) {
    FixedTickConfig config;
    config.effects.spindle = test::kSpindle;
    config.effects.cutting_force = test::kCuttingForce;
    config.effects.energy_removal = test::kEnergyRemoval;
    config.effects.energy_removal->threshold_pressure = 50e6;
    ToolBench bench(1);
    config.tool = {&bench.models[1], {.radius = test::kBurrs[1], .friction = 0.4, .speed = 1000}, 10};
    FixedTick tick(config, bench.bone);
    const DeviceCapabilities arm = steadyArm();
    const Pose hand = test::SwitchingBench::at(kUpHere);
    auto inputs = test::straightPath(test::SwitchingBench::at(test::kBenchTop + 1.1e-3), hand.position, 300,
                                     kButtonRemove);
    inputs.front().other_device = &arm;
    for (const Eigen::Vector3d& along : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0)}) {
        const Eigen::Vector3d from = inputs.back().X_WT_device.position;
        const auto rubbing =
            test::straightPath({from, hand.rotation}, from + 6e-3 * along, 600, kButtonRemove);
        inputs.insert(inputs.end(), rubbing.begin(), rubbing.end());
    }
    for (DeviceInput& input : inputs) input.device.state = uint32_t(SafetyState::kEngaged);
    const auto records = test::lead(tick, inputs);
    double tangential = 0;
    for (size_t n = 300; n < records.size(); ++n)
        tangential = std::max(tangential, Eigen::Vector3d(records[n].f_hand_W).head<2>().norm());
    EXPECT_GT(tangential, 0.3) << "the spindle drives it";
    EXPECT_EQ(leastShare(records), 1);
}

}  // namespace
}  // namespace bonemill
