// Another tool takes over in the tick: what is felt and what is milled are its own.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/tick_choices.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

using test::kBurrs;
using test::ToolBench;

TEST(ToolSwitch, KnowsTheLargestBurr) {
    ToolBench bench(2);
    EXPECT_EQ(bench.tools.count(), 3u);
    EXPECT_EQ(bench.tools.chosen(), 2u);
    EXPECT_EQ(bench.tools.largestBurrRadius(), kBurrs[2]);
}

// At rest on the slab, the tool's centre stands a burr's radius above it.
TEST(ToolSwitch, EachToolRestsOnItsOwnBurr) {
    for (const Preset preset : kPresets) {
        ToolBench bench(0, presetSettings(preset));
        const auto down = test::SwitchingBench::at(test::kBenchTop + 0.1e-3);
        for (const size_t index : {0u, 2u, 1u, 0u}) {
            bench.tools.choose(index);
            const TickRecord last = bench.run(test::straightPath(down, down.position, 400, 0)).back();
            EXPECT_GT(last.contacts, 0u);
            // The thesis' springs give way.
            const double slack = preset == Preset::kThesis2012 ? 0.4 * kBurrs[index] : 0.06e-3;
            EXPECT_NEAR(last.p_WT[2], test::kBenchTop + kBurrs[index], slack)
                << presetName(preset) << " " << index;
        }
    }
}

// What the change starts from is what the hand feels, not what was computed beyond the limit.
TEST(ToolSwitch, AForceAtItsLimitFallsAtOnce) {
    ToolBench bench(2);
    TickConfig config = test::millingConfig();
    config.hand.max_force = 0.5;
    HapticTick tick(config, {bench.bone, &bench.history}, {bench.tools, bench.accuracy});
    // It is deep in the slab for the largest burr, and above it for the smallest.
    const auto hand = test::SwitchingBench::at(test::kBenchTop + 0.7e-3);
    const auto feltAfter = [&](int ticks) {
        return Eigen::Map<const Eigen::Vector3d>(
                   test::lead(tick, test::straightPath(hand, hand.position, ticks, 0)).back().f_hand_W)
            .norm();
    };
    EXPECT_NEAR(feltAfter(200), 0.5, 1e-9);
    bench.tools.choose(0);
    constexpr int kTicks = 10;  // some, in which the small burr goes down to the hand
    EXPECT_LT(feltAfter(kTicks), 0.1);
}

// Returns the largest change of the force from one tick to the next.
double largestStep(const std::vector<TickRecord>& records) {
    double largest = 0;
    for (size_t i = 1; i < records.size(); ++i)
        largest = std::max(largest, (Eigen::Map<const Eigen::Vector3d>(records[i].f_hand_W) -
                                     Eigen::Map<const Eigen::Vector3d>(records[i - 1].f_hand_W))
                                        .norm());
    return largest;
}

// The burr rests at the bottom of its own pit, and the pit is filled again.
TEST(SuddenBone, ThatIsPutBackAroundTheToolPushesAtALimitedRate) {
    ToolBench bench(1);
    const auto above = test::SwitchingBench::at(test::kBenchTop + 1.2e-3);
    const auto bottom = test::SwitchingBench::at(test::kBenchTop - 0.2e-3);
    bench.run(test::straightPath(above, bottom.position, 600, kButtonRemove));
    bench.run(test::straightPath(bottom, bottom.position, 200, 0));
    bench.history.restore();
    const auto back = bench.run(test::straightPath(bottom, bottom.position, 400, 0));
    EXPECT_GT(back.back().f_hand_W[2], 2);
    EXPECT_LE(largestStep(back), 1.001 * HandLimits::kForceRate * 1e-3);
}

// A burr that has no room stays small when another law was in force for a while.
TEST(SuddenLaw, ChangesTheForceAtALimitedRateAndLeavesAToolSmall) {
    ToolBench bench(0);
    const auto hand = test::SwitchingBench::at(test::kBenchTop + 0.1e-3);
    std::vector<TickRecord> records;
    const auto rest = [&](int ticks) {
        const auto more = bench.run(test::straightPath(hand, hand.position, ticks, 0));
        records.insert(records.end(), more.begin(), more.end());
    };
    rest(300);
    records.clear();
    for (const Preset preset : {Preset::kThesis2012, Preset::kBalanced, Preset::kThesis2012, Preset::kFast}) {
        bench.accuracy.choose(AccuracySwitch::choiceOf(preset));
        rest(300);
    }
    EXPECT_LE(largestStep(records), 1.001 * HandLimits::kForceRate * 1e-3);
}

// A tool that had not grown to its size when the thesis' law took over is whole for that law: what it makes
// of a jump of the hand is not slowed down.
TEST(SuddenTool, ThatWasStillGrowingDoesNotLimitTheThesisLaw) {
    const auto hand = test::SwitchingBench::at(test::kBenchTop + 0.1e-3);
    const auto up = test::SwitchingBench::at(test::kBenchTop + 2.5e-3);
    const auto jumped = test::SwitchingBench::at(test::kBenchTop + 4.5e-3);
    ToolBench changed(0);
    changed.run(test::straightPath(hand, hand.position, 300, 0));
    changed.tools.choose(2);
    changed.run(test::straightPath(hand, hand.position, 1, 0));
    changed.accuracy.choose(AccuracySwitch::choiceOf(Preset::kThesis2012));
    changed.run(test::straightPath(hand, up.position, 600, 0));
    ToolBench alone(2, presetSettings(Preset::kThesis2012));
    for (ToolBench* bench : {&changed, &alone}) bench->run(test::straightPath(up, up.position, 600, 0));
    const auto jump = test::straightPath(jumped, jumped.position, 20, 0);
    const auto felt = changed.run(jump), wanted = alone.run(jump);
    EXPECT_GT(largestStep(wanted), 2 * HandLimits::kForceRate * 1e-3) << "the jump shows no limit";
    for (size_t n = 0; n < felt.size(); ++n)
        EXPECT_NEAR(felt[n].f_hand_W[2], wanted[n].f_hand_W[2], 1e-3) << n;
}

// The groove of a tool that was changed to is as that of the same tool from the start.
TEST(ToolSwitch, EachToolMillsWithItsOwnBurr) {
    const auto removedBy = [](size_t first, size_t then) {
        ToolBench bench(first);
        const auto above = test::SwitchingBench::at(test::kBenchTop + 2e-3);
        bench.run(test::straightPath(above, above.position, 10, 0));
        bench.tools.choose(then);
        bench.run(test::straightPath(above, {4.05e-3, 3.95e-3, test::kBenchTop}, 400, kButtonRemove));
        return bench.history.missingVoxels();
    };
    EXPECT_EQ(removedBy(0, 2), removedBy(2, 2));
    EXPECT_EQ(removedBy(2, 0), removedBy(0, 0));
    EXPECT_GT(removedBy(2, 2), 5 * removedBy(0, 0));
}

}  // namespace
}  // namespace bonemill
