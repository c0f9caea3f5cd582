#include "haptic_server/app/scene_effects.h"

#include <cmath>

#include "haptic_server/app/scene_materials.h"

namespace bonemill {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kRpm = 2 * M_PI / 60;  // rad/s

ThermalConfig thermalConfigOf(const scene::Thermal& thermal) {
    constexpr double kPerCubicCentimetre = 1e6;  // 1/m³
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
    if (effects.has_time_removal())
        configs.time_removal = {effects.time_removal().rate_density_per_s() * kDensityCountsPerUnit};
    if (effects.has_add_material())
        configs.add_material = {effects.add_material().rate_density_per_s() * kDensityCountsPerUnit};
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

}  // namespace bonemill
