// Gives a tick no time for all contact points near the tool, or for all that the burr could mill.
#include "haptic_server/core/tick/tick_budget.h"

#include <gtest/gtest.h>

#include "haptic_server/core/tick/fixed_tick.h"
#include "tests/support/led_tick.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

constexpr double kSlabTop = 5e-3, kLargeBurr = 3e-3;

struct BudgetBench {
    explicit BudgetBench(FixedTickConfig config)
        : bone(test::bodyVolume(test::cubeGeometry(64, 0.125e-3),
                                test::halfSpace({0, 0, kSlabTop}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), {.levels = {{1}, {2}, {3}}}),
          tool(test::sphereToolModel(kLargeBurr, 0.125e-3)),
          tick((config.tool.model = &tool, config), bone) {}

    std::vector<TickRecord> run(const std::vector<DeviceInput>& inputs) { return test::lead(tick, inputs); }

    BoneModel bone;
    ToolModel tool;
    FixedTick tick;
};

Pose at(double z) {
    return {{4.05e-3, 3.95e-3, z}, Eigen::Quaterniond::Identity()};
}

// The hand goes down into the slab, rests there, and goes up again.
std::vector<DeviceInput> dip(int rest, int away, uint32_t buttons = 0) {
    auto inputs = test::straightPath(at(8.2e-3), at(7.5e-3).position, 700, buttons);
    inputs.insert(inputs.end(), size_t(rest), inputs.back());
    const auto up = test::straightPath(at(7.5e-3), at(10.5e-3).position, 500, 0);
    inputs.insert(inputs.end(), up.begin(), up.end());
    inputs.insert(inputs.end(), size_t(away), inputs.back());
    return inputs;
}

TEST(TickBudget, TooManyPointsForATickMeanACoarserShellAndSaySo) {
    FixedTickConfig config;
    config.accuracy.sample_spacing = 0;
    config.gradient.contact.stiffness_per_area = 1e10;  // a wide contact
    const auto unlimited = BudgetBench(config).run(dip(1000, 0));
    uint32_t most = 0;
    for (const TickRecord& r : unlimited) most = std::max(most, r.candidates);
    ASSERT_GT(most, 60u);

    config.gradient.most_point_tests = 3 * most;  // less than one evaluation per iteration
    BudgetBench bench(config);
    const auto records = bench.run(dip(1000, 2500));
    const TickRecord& pressed = records[1699];
    EXPECT_TRUE(pressed.faults & kFaultCoarserShell);
    EXPECT_LT(pressed.candidates, most / 2);
    // The areas add up to the same at every level.
    EXPECT_NEAR(pressed.f_hand_W[2], unlimited[1699].f_hand_W[2], 0.15 * unlimited[1699].f_hand_W[2]);
    for (const TickRecord& r : records) {
        EXPECT_TRUE(std::isfinite(r.f_hand_W[2]));
    }
    // After the contact the points asked for come back, a level a second.
    EXPECT_FALSE(records.back().faults & kFaultCoarserShell);
    EXPECT_EQ(bench.bone.shell.scalingFactor(bench.bone.shell.followed()), 1);
}

TEST(TickBudget, APresetThatThereIsNoTimeForGivesWayToTheNextOne) {
    const AccuracySettings exact = presetSettings(Preset::kExact),
                           balanced = presetSettings(Preset::kBalanced), fast = presetSettings(Preset::kFast);
    AffordablePreset affordable(1e-3);
    for (const AccuracySettings& next : {balanced, fast}) {
        SpoStep cut_short;
        cut_short.has_contact_overflow = true;
        EXPECT_EQ(affordable.settings(exact, cut_short), next);
        EXPECT_FALSE(cut_short.has_contact_overflow);  // the shell stays as fine as it is
    }
    SpoStep still_too_much;
    still_too_much.has_contact_overflow = true;
    EXPECT_EQ(affordable.settings(exact, still_too_much), fast);
    EXPECT_TRUE(still_too_much.has_contact_overflow);
    EXPECT_EQ(AffordablePreset::faultOf(balanced), uint32_t(kFaultAsBalanced));
    EXPECT_EQ(AffordablePreset::faultOf(fast), uint32_t(kFaultAsFast));

    for (const AccuracySettings& next : {balanced, exact}) {
        SpoStep quiet, busy;
        quiet.budget_share = 0.1, busy.budget_share = 0.4;
        for (int n = 0; n < 2000; ++n) EXPECT_NE(affordable.settings(exact, busy), next);
        for (int n = 0; n < 1001; ++n) affordable.settings(exact, quiet);
        EXPECT_EQ(affordable.settings(exact, busy), next);
    }
    AccuracySettings own = exact;
    own.sample_spacing = 0;
    EXPECT_EQ(affordable.settings(own, still_too_much), own);
}

TEST(TickBudget, PlentyOfTimeChangesNothing) {
    FixedTickConfig config;
    config.effects.time_removal = test::kTimeRemoval;
    config.tool.burr.radius = kLargeBurr;
    const auto free = BudgetBench(config).run(dip(300, 0, kButtonRemove));
    TickBudget::apply(config.dt, config.gradient, config.most_milled_cells);
    const auto budgeted = BudgetBench(config).run(dip(300, 0, kButtonRemove));
    size_t removed = 0;
    for (size_t n = 0; n < free.size(); ++n) {
        removed += free[n].removed_voxels;
        ASSERT_EQ(budgeted[n].f_hand_W[2], free[n].f_hand_W[2]) << n;
        ASSERT_EQ(budgeted[n].removed_voxels, free[n].removed_voxels) << n;
        ASSERT_EQ(budgeted[n].faults & ~uint32_t(kFaultOverrun), 0u) << n;
    }
    EXPECT_GT(removed, 0u);
}

TEST(TickBudget, MillingThatIsCutShortIsAFault) {
    FixedTickConfig config;
    config.effects.time_removal = test::kTimeRemoval;
    config.tool.burr.radius = kLargeBurr;
    config.most_milled_cells = 200;
    BudgetBench bench(config);
    uint32_t faults = 0;
    for (const TickRecord& r : bench.run(dip(300, 0, kButtonRemove))) faults |= r.faults;
    EXPECT_TRUE(faults & kFaultMillingCutShort);
}

TEST(TickBudget, AFasterLoopMayDoLessInATick) {
    TickConfig slow, fast;
    TickBudget::apply(1e-3, slow.gradient, slow.most_milled_cells);
    TickBudget::apply(0.25e-3, fast.gradient, fast.most_milled_cells);
    EXPECT_EQ(slow.gradient.most_point_tests, 100'000u);
    EXPECT_EQ(slow.most_milled_cells, 75'000u);
    EXPECT_EQ(fast.gradient.most_point_tests, 25'000u);
    EXPECT_EQ(fast.most_milled_cells, 18'750u);
}

}  // namespace
}  // namespace bonemill
