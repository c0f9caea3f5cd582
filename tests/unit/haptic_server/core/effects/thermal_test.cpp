#include <gtest/gtest.h>

#include "tests/support/typical_effects.h"
#include "tests/unit/haptic_server/core/effects/tissue_bench.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

// The configuration has time removal at rate 0, so that the burr only rubs.
struct HotBench : TissueBench {
    HotBench() : TissueBench(halfSpace({-1, 0, 0}, Vector3d::UnitX())) {
        config.tool.burr.speed = 1000;  // rad/s
        config.tool.burr.friction = 0.5;
        config.effects.thermal = test::kThermal;
    }
    // The burr leans over by 45°, so that its side rubs, and is pressed onto the bone.
    std::vector<TickRecord> press(uint32_t buttons, int ticks) {
        FixedTick tick = makeTick();
        const Pose start{{4e-3, 4e-3, kTop + kBurr + 0.1e-3}, expRotation({M_PI / 4, 0, 0})};
        auto inputs = straightPath(start, start.position - Vector3d(0, 0, 0.6e-3), 100, buttons);
        inputs.insert(inputs.end(), size_t(ticks), inputs.back());
        return run(tick, inputs);
    }
};

TEST(Thermal, PowerIsFrictionTimesRubbingSpeed) {
    HotBench bench;
    const TickRecord last = bench.press(kButtonRemove, 300).back();
    const double force = last.f_hand_W[2];
    EXPECT_GT(force, 0.5);
    // ρ is that of the ball's lowest point, 45° off the axis.
    const double expected = 0.5 * force * 1000 * kBurr * std::sqrt(0.5);
    EXPECT_NEAR(last.effects.cutting_power / expected, 1, 0.08);
    EXPECT_GT(last.effects.temperature, 40);
}

// What cannot cut heats by its own friction, and by the share of a burr's edges, of grains or of a drill.
TEST(Thermal, RubbingHasItsOwnShareOfTheHeat) {
    HotBench cutting;
    cutting.config.effects.thermal->heat.wet_transfer = 0;
    const TickRecord cut = cutting.press(kButtonRemove, 300).back();
    const double by_cutting = test::kThermal.heat_share * double(cut.effects.cutting_power);
    for (const BurrGrit grit : {BurrGrit::kFluted, BurrGrit::kDiamond, BurrGrit::kDrill}) {
        constexpr double kShare = 0.6;
        HotBench rubbing;
        rubbing.config.effects.time_removal.reset();
        rubbing.config.effects.energy_removal = test::kSharpRemoval;
        rubbing.config.effects.energy_removal->threshold_pressure = 1e9;
        rubbing.config.tool.burr.grit = grit;
        rubbing.config.tool.burr.rubbing_friction = 0.4;
        ThermalConfig& thermal = *rubbing.config.effects.thermal;
        thermal.heat.wet_transfer = 0;
        thermal.heat_share = 0;
        thermal.rubbing_heat_share = grit == BurrGrit::kFluted ? kShare : 0;
        thermal.diamond_rubbing_heat_share = grit == BurrGrit::kDiamond ? kShare : 0;
        thermal.drill_rubbing_heat_share = grit == BurrGrit::kDrill ? kShare : 0;
        const TickRecord rubbed = rubbing.press(kButtonRemove, 300).back();
        EXPECT_EQ(rubbed.effects.removal_power, 0);
        const double by_rubbing = kShare * double(rubbed.effects.cutting_power);
        EXPECT_NEAR(by_rubbing / by_cutting, 3 * 0.4 / 0.5, 0.05 * 2.4);
        EXPECT_NEAR(double(rubbed.effects.temperature - 37) / double(cut.effects.temperature - 37),
                    by_rubbing / by_cutting, 0.05 * by_rubbing / by_cutting);
    }
}

TEST(Thermal, WithoutThePedalNothingHeats) {
    HotBench bench;
    const TickRecord last = bench.press(0, 300).back();
    EXPECT_GT(last.f_hand_W[2], 0.5);
    EXPECT_EQ(last.effects.cutting_power, 0);
    EXPECT_EQ(last.effects.temperature, 37);
    EXPECT_EQ(last.effects.events, 0u);
}

TEST(Thermal, TooHotIsToldAndCounted) {
    HotBench bench;
    bench.config.effects.thermal->heat_share = 0.2;
    for (const TickRecord& record : bench.press(kButtonRemove, 2000)) {
        EXPECT_EQ(bool(record.effects.events & kEventTooHot), record.effects.temperature >= 47);
        if (record.effects.necrotic_volume > 0) return;
    }
    FAIL() << "nothing has died";
}

TEST(Thermal, TheScannedBoneIsColdAndAliveAgain) {
    HotBench bench;
    bench.config.effects.thermal->heat_share = 0.2;
    BoneHistory history(bench.bone);
    FixedTick tick = bench.makeTick(&history);
    const Pose start{{4e-3, 4e-3, kTop + kBurr + 0.1e-3}, expRotation({M_PI / 4, 0, 0})};
    auto rubbing = straightPath(start, start.position - Vector3d(0, 0, 0.6e-3), 100, kButtonRemove);
    rubbing.insert(rubbing.end(), 1000, rubbing.back());
    const EffectRecord hot = bench.run(tick, rubbing).back().effects;
    EXPECT_GT(hot.necrotic_volume, 0);
    history.restore();
    for (const TickRecord& record : bench.run(tick, straightPath(start, start.position, 10, 0))) {
        EXPECT_EQ(record.effects.temperature, 37);
        EXPECT_EQ(record.effects.necrotic_volume, 0);
        EXPECT_EQ(record.effects.events, 0u);
    }
    EXPECT_GT(bench.run(tick, rubbing).back().effects.necrotic_volume, 0.9f * hot.necrotic_volume);
}

TEST(Thermal, IrrigationKeepsTheBoneCooler) {
    const auto hottest = [](double transfer) {
        HotBench bench;
        bench.config.effects.thermal->heat.wet_transfer = transfer;
        return bench.press(kButtonRemove, 1500).back().effects.temperature;
    };
    EXPECT_LT(hottest(20000) - 37, 0.9f * (hottest(0) - 37));
}

}  // namespace
}  // namespace bonemill
