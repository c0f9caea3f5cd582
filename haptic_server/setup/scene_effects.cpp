#include "haptic_server/setup/scene_effects.h"

#include <algorithm>
#include <cmath>

#include "common/config/field_unit.h"
#include "common/units.h"
#include "common/user_error.h"
#include "haptic_server/setup/scene_materials.h"

namespace bonemill {
namespace {

EnergyRemovalConfig energyRemovalOf(const scene::EnergyRemoval& removal) {
    return {.specific_energy = removal.specific_energy_j_per_mm3() * kPerCubicMillimetre,
            .density_exponent = removal.density_exponent(),
            .threshold_pressure = removal.threshold_pressure_mpa() * kMega,
            .diamond_energy_factor = removal.diamond_energy_factor()};
}

SpindleConfig spindleConfigOf(const scene::Spindle& spindle) {
    constexpr double kTorquePerKrpm = kMillimetre / (1000 * kRpm);  // N·m·s/rad
    return {.inertia = spindle.inertia_kg_mm2() * kMillimetre * kMillimetre,
            .max_torque = spindle.max_torque_nmm() * kMillimetre,
            .droop = spindle.droop_nmm_per_krpm() * kTorquePerKrpm,
            .drag = spindle.drag_nmm_per_krpm() * kTorquePerKrpm};
}

ThermalConfig thermalConfigOf(const scene::Thermal& thermal) {
    ThermalConfig config;
    config.heat_share = thermal.heat_share();
    config.irrigation_radius = thermal.irrigation_radius_mm() * kMillimetre;
    config.heat = {.cell = thermal.cell_mm() * kMillimetre,
                   .conductivity = thermal.conductivity_w_per_m_k(),
                   .heat_capacity = thermal.heat_capacity_j_per_cm3_k() * kPerCubicCentimetre,
                   .perfusion = thermal.perfusion_per_s(),
                   .body_temperature = thermal.body_temperature_c(),
                   .wet_transfer = thermal.irrigation_w_per_m2_k(),
                   .irrigation_temperature = thermal.irrigation_temperature_c(),
                   .dry_transfer = thermal.dry_w_per_m2_k(),
                   .necrosis_temperature = thermal.necrosis_temperature_c(),
                   .necrosis_time = thermal.necrosis_time_s()};
    return config;
}

}  // namespace

Burr burrOf(const scene::Tool& tool) {
    Burr burr;
    burr.kind = BurrKind(tool.burr_kind());
    burr.grit = BurrGrit(tool.burr_grit());
    burr.radius = tool.burr_radius_mm() * kMillimetre;
    burr.length = tool.burr_length_mm() * kMillimetre;
    burr.tip_radius = tool.burr_tip_radius_mm() * kMillimetre;
    burr.friction = tool.burr_friction();
    burr.speed = tool.speed_rpm() * kRpm;
    return burr;
}

EffectConfigs effectConfigsOf(const scene::Scene& scene) {
    const scene::Effects& effects = scene.effects();
    EffectConfigs configs;
    configs.materials = materialTableOf(scene);
    if (std::ranges::any_of(configs.materials, [](const auto& m) { return m.stiffness_factor != 1; }))
        configs.material_stiffness.emplace();
    if (effects.has_energy_removal()) configs.energy_removal = energyRemovalOf(effects.energy_removal());
    if (effects.has_time_removal())
        configs.time_removal = {effects.time_removal().rate_density_per_s() * kDensityCountsPerUnit};
    if (effects.has_add_material())
        configs.add_material = {effects.add_material().rate_density_per_s() * kDensityCountsPerUnit};
    if (effects.has_spindle()) configs.spindle = spindleConfigOf(effects.spindle());
    if (effects.has_cutting_force())
        configs.cutting_force = {effects.cutting_force().slow_speed_mm_per_s() * kMillimetre,
                                 effects.cutting_force().smoothing_time_ms() * kMillisecond};
    if (effects.has_surface_friction())
        configs.surface_friction = {effects.surface_friction().coefficient(),
                                    effects.surface_friction().presliding_stiffness_n_per_mm() / kMillimetre};
    if (effects.has_burr_vibration())
        configs.burr_vibration = {effects.burr_vibration().amplitude_per_force(),
                                  effects.burr_vibration().max_amplitude_n(),
                                  effects.burr_vibration().diamond_factor()};
    if (effects.has_virtual_fixture()) {
        const scene::VirtualFixture& fixture = effects.virtual_fixture();
        configs.virtual_fixture = {.distance = fixture.distance_mm() * kMillimetre,
                                   .stiffness = fixture.stiffness_n_per_mm() / kMillimetre,
                                   .max_force = fixture.max_force_n(),
                                   .hand_force_scale = fixture.hand_force_scale()};
    }
    if (effects.has_thermal()) configs.thermal = thermalConfigOf(effects.thermal());
    if (effects.has_protected_structures())
        configs.protected_structures = {effects.protected_structures().warning_distance_mm() * kMillimetre};
    return configs;
}

RecordedEffects recordedEffectsOf(const scene::Effects& e) {
    return {.burr = e.has_energy_removal() || e.has_cutting_force() || e.has_spindle() ||
                    e.has_burr_vibration() || e.has_thermal(),
            .heat = e.has_thermal(),
            .protection = e.has_protected_structures()};
}

void mapRawValues(EffectConfigs& configs, const LoadedScene& loaded, const DensityMapping& mapping) {
    const scene::EnergyRemoval& removal = loaded.scene.effects().energy_removal();
    if (!configs.energy_removal || !removal.has_reference_value()) return;
    const double share = (removal.reference_value() - mapping.low) / (mapping.high - mapping.low);
    const std::string path = "effects.energy_removal.reference_value";
    if (!(share > 0))
        throw UserError(placeOf(loaded.file.string(), loaded.lines, path) + "field `" + path +
                        "` = " + numberText(removal.reference_value()) +
                        " is not above the lower end of the window, " + numberText(mapping.low) +
                        ", which is no bone at all");
    configs.energy_removal->reference_density = share * kMaxDensity;
}

}  // namespace bonemill
