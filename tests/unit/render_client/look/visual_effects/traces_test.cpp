#include "render_client/look/visual_effects/traces.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "render_client/look/visual_effects/visual_effects.h"

namespace bonemill {
namespace {

constexpr double kTraceRadius = 1e-3;
const Eigen::Vector3f kContact(0, 0, -1e-3f);  // under a burr in V's origin

EffectInput pressingBurr() {
    EffectInput input;
    input.X_VT = Pose{};
    input.burr_radius = kTraceRadius;
    input.is_pedal_down = true;
    input.burr_force = 2;
    input.towards_bone_V = -Eigen::Vector3d::UnitZ();
    return input;
}
EffectInput hotBurr(double hottest_c) {
    EffectInput input = pressingBurr();
    input.hottest_c = hottest_c;
    return input;
}

class Traces : public testing::Test {
  protected:
    Traces() {
        wish_.mutable_browning();
        wish_.mutable_bruising();
        effects_.emplace(wish_, kTraceRadius);
    }
    float burnt() const { return effects_->film()->at(SurfaceFilm::kBurn, kContact); }
    float bruised() const { return effects_->film()->at(SurfaceFilm::kBruise, kContact); }

    scene::Effects wish_;
    std::optional<VisualEffects> effects_;
};

TEST_F(Traces, BoneBrownsAbove55DegreesAndIsCharredAt70) {
    effects_->take(hotBurr(54.9));
    EXPECT_EQ(burnt(), 0);
    effects_->take(hotBurr(58));
    EXPECT_NEAR(burnt(), 0.2, 0.01);
    effects_->take(hotBurr(70));
    EXPECT_EQ(burnt(), 1);
    effects_->advance(60);
    EXPECT_EQ(burnt(), 1) << "stays";
    EXPECT_EQ(effects_->film()->at(SurfaceFilm::kBurn, {0, 0, 1e-3f}), 0) << "only under the burr";
}

// Bone elsewhere is still hot and cools down.
TEST_F(Traces, HeatThatFallsIsNotThatOfTheBurr) {
    EffectInput idle = hotBurr(80);
    idle.burr_force = 0;
    effects_->take(idle);
    effects_->take(hotBurr(79));
    effects_->take(hotBurr(78));
    EXPECT_EQ(burnt(), 0);
    effects_->take(hotBurr(78.5));
    EXPECT_EQ(burnt(), 1);
}

TEST_F(Traces, NobodyKnowsWithoutATemperature) {
    effects_->take(pressingBurr());
    EXPECT_EQ(burnt(), 0);
}

TEST_F(Traces, ACutTakesTheBrownAway) {
    effects_->take(hotBurr(70));
    EffectInput cutting = hotBurr(40);
    cutting.X_VT->position = kContact.cast<double>();
    cutting.removed = 1e-9;
    effects_->take(cutting);
    EXPECT_EQ(burnt(), 0);
}

TEST_F(Traces, WhatIsTouchedReddensWithTheForceAndDamageIsDarkest) {
    EffectInput touching = pressingBurr();
    touching.is_pedal_down = false;
    touching.protected_force = 1;
    effects_->take(touching);
    EXPECT_EQ(bruised(), 0);
    touching.is_protected_touched = true;
    effects_->take(touching);
    EXPECT_NEAR(bruised(), 0.5f * Bruising::kMostOfTouch, 0.01);
    touching.protected_force = 50;
    effects_->take(touching);
    EXPECT_NEAR(bruised(), Bruising::kMostOfTouch, 0.01);
    EffectInput cutting = pressingBurr();
    cutting.is_protected_damaged = true;
    effects_->take(cutting);
    EXPECT_GT(effects_->film()->at(SurfaceFilm::kBruise, {0, 0, 0}), 0.99f);
}

TEST_F(Traces, OfBoneThatWasPutBackNothingIsRemembered) {
    EffectInput all = hotBurr(70);
    all.is_protected_touched = true;
    effects_->take(all);
    ASSERT_GT(burnt() + bruised(), 1);
    effects_->forget();
    EXPECT_EQ(burnt() + bruised(), 0);
}

TEST(EffectInput, KnowsHeatAndTouchOnlyWhereTheyAreTold) {
    topics::ToolState tool;
    EXPECT_FALSE(effectInputOf(tool, {}).hottest_c);
    tool.mutable_effects()->set_temperature_c(1e9);
    tool.mutable_effects()->set_events(topics::EffectState::PROTECTED_DAMAGED);
    const EffectInput input = effectInputOf(tool, {});
    EXPECT_EQ(input.hottest_c, 1000);
    EXPECT_TRUE(input.is_protected_damaged);
    EXPECT_FALSE(input.is_protected_touched);
}

}  // namespace
}  // namespace bonemill
