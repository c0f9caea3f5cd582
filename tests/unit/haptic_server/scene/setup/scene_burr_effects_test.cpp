// Reads what a scene says of a driven burr, in SI.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "common/base/user_error.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

TEST(SceneEffects, AreNotConfiguredUnlessListed) {
    const EffectConfigs configs = effectConfigsOf({});
    EXPECT_FALSE(configs.spindle || configs.cutting_force || configs.surface_friction ||
                 configs.burr_vibration);
}

// The tests of the effects count on figures of their own; they are to be those that people get.
TEST(SceneEffects, DefaultsAreWhatTheEffectsAreTestedWith) {
    scene::Scene scene;
    scene.mutable_effects()->mutable_spindle();
    scene.mutable_effects()->mutable_cutting_force();
    scene.mutable_effects()->mutable_surface_friction();
    scene.mutable_effects()->mutable_burr_vibration();
    const EffectConfigs configs = effectConfigsOf(scene);
    EXPECT_DOUBLE_EQ(configs.spindle->inertia, test::kSpindle.inertia);
    EXPECT_DOUBLE_EQ(configs.spindle->max_torque, test::kSpindle.max_torque);
    EXPECT_NEAR(configs.spindle->droop, test::kSpindle.droop, 0.01 * test::kSpindle.droop);
    EXPECT_NEAR(configs.spindle->drag, test::kSpindle.drag, 0.01 * test::kSpindle.drag);
    EXPECT_DOUBLE_EQ(configs.cutting_force->slow_speed, test::kCuttingForce.slow_speed);
    EXPECT_DOUBLE_EQ(configs.cutting_force->smoothing_time, test::kCuttingForce.smoothing_time);
    EXPECT_DOUBLE_EQ(configs.surface_friction->coefficient, test::kSurfaceFriction.coefficient);
    EXPECT_DOUBLE_EQ(configs.surface_friction->presliding_stiffness,
                     test::kSurfaceFriction.presliding_stiffness);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->amplitude_per_force, test::kBurrVibration.amplitude_per_force);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->max_amplitude, test::kBurrVibration.max_amplitude);
    EXPECT_DOUBLE_EQ(configs.burr_vibration->diamond_factor, test::kBurrVibration.diamond_factor);
}

// A field that nothing reads, or a parameter without its field, would be a silent one.
TEST(SceneEffects, EveryFieldOfAnEffectIsReadByItsDeclaration) {
    forEachConfig([]<class Config>() {
        const auto* const place = scene::Effects::descriptor()->FindFieldByName(Config::kName);
        std::set<std::string> fields, read;
        if (place)
            for (int n = 0; n < place->message_type()->field_count(); ++n)
                fields.insert(place->message_type()->field(n)->name());
        fields.erase("reference_value");  // mapRawValues() reads it
        if constexpr (requires { Config::parameters(); })
            for (const auto& parameter : Config::parameters()) read.insert(parameter.field);
        EXPECT_EQ(fields, read) << Config::kName;
    });
}

TEST(SceneEffects, EnergyOfBoneRisesWithItsDensityUnlessTheSceneSaysOtherwise) {
    scene::Scene scene;
    scene.mutable_effects()->mutable_energy_removal();
    const EnergyRemovalConfig removal = *effectConfigsOf(scene).energy_removal;
    EXPECT_DOUBLE_EQ(removal.specific_energy, test::kEnergyRemoval.specific_energy);
    EXPECT_EQ(removal.reference_density, test::kEnergyRemoval.reference_density);
    EXPECT_EQ(removal.density_exponent, 1.5);
    EXPECT_EQ(removal.diamond_energy_factor, test::kEnergyRemoval.diamond_energy_factor);
    EXPECT_EQ(removal.drill_energy_factor, test::kEnergyRemoval.drill_energy_factor);
    EXPECT_DOUBLE_EQ(removal.diamond_edge, test::kEnergyRemoval.diamond_edge);
    EXPECT_DOUBLE_EQ(removal.fluted_edge, test::kEnergyRemoval.fluted_edge);
    EXPECT_DOUBLE_EQ(removal.drill_edge, test::kEnergyRemoval.drill_edge);
}

TEST(SceneEffects, EnergiesThatNoBoneHasAreRefused) {
    LoadedScene loaded;
    scene::EnergyRemoval& removal = *loaded.scene.mutable_effects()->mutable_energy_removal();
    const DensityMapping mapping{.low = 0, .high = 2000};
    const auto densityOf = [&](double reference_value, double exponent) {
        removal.set_reference_value(reference_value);
        removal.set_density_exponent(exponent);
        EffectConfigs configs = effectConfigsOf(loaded.scene);
        mapRawValues(configs, loaded, mapping);
        return configs.energy_removal->reference_density;
    };
    EXPECT_DOUBLE_EQ(densityOf(1000, 4), kMaxDensity / 2.0);
    EXPECT_NO_THROW(densityOf(1e-300, 0));
    EXPECT_THROW(densityOf(1e-300, 4), UserError);
    EXPECT_THROW(densityOf(1, 2), UserError);
    EXPECT_THROW(densityOf(1e6, 4), UserError);
    EXPECT_THROW(densityOf(0, 1), UserError);
}

TEST(SceneEffects, RecordWhatTheyDeclare) {
    scene::Effects effects;
    effects.mutable_time_removal();
    effects.mutable_surface_friction();
    EXPECT_FALSE(recordedEffectsOf(effects).any());
    effects.mutable_spindle();
    EXPECT_TRUE(recordedEffectsOf(effects).burr);
    EXPECT_FALSE(recordedEffectsOf(effects).heat || recordedEffectsOf(effects).protection);
    effects.mutable_thermal();
    effects.mutable_protected_structures();
    EXPECT_TRUE(recordedEffectsOf(effects).heat && recordedEffectsOf(effects).protection);
}

// At 1000 turns a minute less than wanted, 5 N·mm are missing.
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
