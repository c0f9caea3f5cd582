// Compares one picture per visual effect with those in the repository, and checks what hiding them must do.
#include <gtest/gtest.h>

#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/golden.h"
#include "tests/gl/milled_scene.h"
#include "tests/gl/milling_session.h"

namespace bonemill {
namespace {

constexpr int kEffectWidth = 320, kEffectHeight = 240;

const VoxelVolume& ball() {
    static const VoxelVolume kBall = [] {
        VolumeGeometry geometry;
        geometry.dims.setConstant(65);
        geometry.spacing.setConstant(2.5e-4);
        return test::MillingSession::makeVolume(geometry, [](const Eigen::Vector3d& p) {
            return (p - test::kBlockCenter).norm() - test::kBlockRadius;
        });
    }();
    return kBall;
}

class EffectPictures : public testing::Test {
  protected:
    EffectPictures() : context_(kEffectWidth, kEffectHeight) {}

    // The burr has just cut a groove into the front of the ball.
    void mill(const scene::Effects& wish, Quality quality = Quality::kFull, bool has_effects = true) {
        begin(has_effects);
        scene_->settings().quality = quality;
        scene_->setSceneInfo(infoOf(wish));
        session_->show(*scene_);
        stroke(0.4);
    }
    void begin(bool has_effects) {
        scene_.emplace(context_.gl(), has_effects);
        session_.emplace(ball(), test::kBurrRadius);
        scene_->settings().show_hud = false;
        scene_->settings().show_force = false;
    }
    static topics::SceneInfo infoOf(const scene::Effects& wish) {
        topics::SceneInfo info = test::milledInfo();
        *info.mutable_viewer_effects() = wish;
        info.mutable_camera()->set_distance_m(0.018);
        return info;
    }
    void stroke(double seconds) {
        Pose from = at_, to = at_;
        to.position += Eigen::Vector3d(2.4e-3 * seconds / 0.4, 0, -4e-4);
        session_->stroke(*scene_, from, to, seconds, {.spin_speed = 1500});
        at_ = to;
    }
    void leave(double seconds) {
        at_.position += Eigen::Vector3d(2e-3, -3e-3, 2e-3);
        session_->wait(*scene_, at_, seconds, {.is_pedal_down = false});
    }
    Picture draw() {
        scene_->draw(kEffectWidth, kEffectHeight, 1);
        return context_.read();
    }

    OsmesaContext context_;
    std::optional<RenderScene> scene_;
    std::optional<test::MillingSession> session_;
    Pose at_ =
        test::toolAt(test::kBlockCenter + Eigen::Vector3d(-1.2e-3, -5.4e-3, 1.4e-3), {-0.75, -0.25, 0.6});
};

TEST_F(EffectPictures, BoneDust) {
    scene::Effects wish;
    wish.mutable_bone_dust()->set_grain_size_um(200);
    mill(wish);
    EXPECT_EQ(test::goldenProblem(draw(), "effect_dust"), "");
}

TEST_F(EffectPictures, Bleeding) {
    scene::Effects wish;
    wish.mutable_bleeding()->set_delay_s(0);
    wish.mutable_bleeding()->set_seep_per_s(2);
    mill(wish);
    leave(1.5);
    EXPECT_EQ(test::goldenProblem(draw(), "effect_bleeding"), "");
}

TEST_F(EffectPictures, BoneThatIsPutBackHasNoBloodOnIt) {
    scene::Effects wish;
    wish.mutable_bleeding()->set_delay_s(0);
    wish.mutable_bleeding()->set_seep_per_s(2);
    mill(wish);
    leave(1.5);
    topics::Status status;
    scene_->setStatus(status);
    const Picture bloody = draw();
    status.set_removed_mm3(1);
    scene_->setStatus(status);
    EXPECT_TRUE(draw() == bloody);
    status.set_bone_restores(1);
    scene_->setStatus(status);
    EXPECT_FALSE(draw() == bloody);
}

TEST_F(EffectPictures, Irrigation) {
    scene::Effects wish;
    wish.mutable_irrigation();
    mill(wish);
    EXPECT_EQ(test::goldenProblem(draw(), "effect_irrigation"), "");
}

TEST_F(EffectPictures, BurrSpin) {
    scene::Effects wish;
    wish.mutable_burr_spin()->set_flutes(6);
    mill(wish);
    draw();
    session_->wait(*scene_, at_, 1.0 / 60, {.spin_speed = 12, .is_pedal_down = false});
    EXPECT_EQ(test::goldenProblem(draw(), "effect_spin"), "");
}

// The burr rubs where it is, at such a temperature.
TEST_F(EffectPictures, Browning) {
    scene::Effects wish;
    wish.mutable_browning();
    mill(wish);
    for (int n = 0; n < 3; ++n) {
        topics::ToolState tool = test::makeToolState(at_, at_, 1);
        tool.set_tick(1000 + uint64_t(n));
        test::setVector(Eigen::Vector3d(0, -2, 0), tool.mutable_force_n());
        tool.mutable_effects()->set_burr_force_n(2);
        tool.mutable_effects()->set_temperature_c(58 + 7 * n);
        scene_->setToolState(tool);
        at_.position.x() -= 7e-4;
    }
    leave(0.5);
    EXPECT_EQ(test::goldenProblem(draw(), "effect_browning"), "");
}

// Its nodes come before its scene info, as a restarted server sends them.
TEST_F(EffectPictures, AfterARestartTheEffectsKnowTheBone) {
    topics::SceneInfo all;
    test::listAllEffects(all);
    const Pose start = at_;
    mill(all.viewer_effects());
    const Picture fresh = draw();
    at_ = start;
    begin(true);
    topics::SceneInfo info = infoOf(all.viewer_effects());
    info.set_epoch(1);
    scene_->setSceneInfo(info);
    session_->show(*scene_);
    scene_->clearNodes();
    session_->show(*scene_);
    info.set_epoch(2);
    scene_->setSceneInfo(info);
    stroke(0.4);
    EXPECT_TRUE(draw() == fresh);
}

TEST_F(EffectPictures, WhatIsLeftOutOrHiddenLeavesNoTrace) {
    const Pose start = at_;
    mill({});
    const Picture without = draw();
    EXPECT_FALSE(scene_->effects());
    topics::SceneInfo all;
    test::listAllEffects(all);
    at_ = start;
    mill(all.viewer_effects(), Quality::kFull, false);
    EXPECT_FALSE(scene_->effects());
    EXPECT_TRUE(draw() == without) << "--no-effects";
    at_ = start;
    mill(all.viewer_effects());
    EXPECT_FALSE(draw() == without);
    scene_->settings().hides_effects.fill(true);
    EXPECT_TRUE(draw() == without) << "hidden";
}

// Quick quality draws only what changed, with effects, too.
TEST_F(EffectPictures, QuickIsTheOneThatIsDrawnWhole) {
    topics::SceneInfo all;
    test::listAllEffects(all);
    mill(all.viewer_effects(), Quality::kQuick);
    draw();
    for (int n = 0; n < 12; ++n) {
        n < 7 ? stroke(1.0 / 30) : leave(n == 7 ? 0.5 : 0.1);
        if (n > 8) scene_->settings().hides_effects[size_t(n % 4)] ^= true;
        const Picture kept = draw();
        scene_->drawWholeNext();
        EXPECT_TRUE(kept == draw()) << "picture " << n;
    }
}

}  // namespace
}  // namespace bonemill
