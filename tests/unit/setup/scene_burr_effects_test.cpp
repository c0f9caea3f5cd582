// Reads what a scene says of a driven burr, in SI.
#include <gtest/gtest.h>

#include "haptic_server/setup/scene_effects.h"

namespace bonemill {
namespace {

TEST(SceneEffects, AreNotConfiguredUnlessListed) {
    const EffectConfigs configs = effectConfigsOf({});
    EXPECT_FALSE(configs.spindle || configs.cutting_force || configs.surface_friction ||
                 configs.burr_vibration);
}

TEST(SceneEffects, DefaultsAreThoseOfTheEffects) {
    scene::Scene scene;
    scene.mutable_effects()->mutable_spindle();
    scene.mutable_effects()->mutable_cutting_force();
    scene.mutable_effects()->mutable_surface_friction();
    scene.mutable_effects()->mutable_burr_vibration();
    const EffectConfigs configs = effectConfigsOf(scene);
    EXPECT_DOUBLE_EQ(configs.spindle->inertia, SpindleConfig{}.inertia);
    EXPECT_DOUBLE_EQ(configs.spindle->max_torque, SpindleConfig{}.max_torque);
    EXPECT_NEAR(configs.spindle->droop, SpindleConfig{}.droop, 0.01 * SpindleConfig{}.droop);
    EXPECT_NEAR(configs.spindle->drag, SpindleConfig{}.drag, 0.01 * SpindleConfig{}.drag);
    EXPECT_DOUBLE_EQ(configs.cutting_force->slow_speed, CuttingForceConfig{}.slow_speed);
    EXPECT_DOUBLE_EQ(configs.cutting_force->smoothing_time, CuttingForceConfig{}.smoothing_time);
    EXPECT_DOUBLE_EQ(configs.surface_friction->coefficient, SurfaceFrictionConfig{}.coefficient);
    EXPECT_DOUBLE_EQ(configs.surface_friction->presliding_stiffness,
                     SurfaceFrictionConfig{}.presliding_stiffness);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->amplitude_per_force, BurrVibrationConfig{}.amplitude_per_force);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->max_amplitude, BurrVibrationConfig{}.max_amplitude);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->diamond_factor, BurrVibrationConfig{}.diamond_factor);
}

// 5 N·mm missing at 1000 turns a minute less than wanted.
TEST(SceneEffects, DroopIsTorquePerThousandTurnsAMinute) {
    scene::Scene scene;
    scene.mutable_effects()->mutable_spindle()->set_droop_nmm_per_krpm(5);
    scene.mutable_effects()->mutable_spindle()->set_inertia_kg_mm2(2);
    const SpindleConfig spindle = *effectConfigsOf(scene).spindle;
    EXPECT_DOUBLE_EQ(spindle.droop * 1000 * 2 * M_PI / 60, 5e-3);
    EXPECT_DOUBLE_EQ(spindle.inertia, 2e-6);
}

}  // namespace
}  // namespace bonemill
