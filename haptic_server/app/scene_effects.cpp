#include "haptic_server/app/scene_effects.h"

#include <cmath>

namespace bonemill {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kMillisecond = 1e-3;
constexpr double kRpm = 2 * M_PI / 60;  // rad/s

SpindleConfig spindleConfigOf(const scene::Spindle& spindle) {
    constexpr double kTorquePerKrpm = kMillimetre / (1000 * kRpm);  // N·m·s/rad
    return {.inertia = spindle.inertia_kg_mm2() * kMillimetre * kMillimetre,
            .max_torque = spindle.max_torque_nmm() * kMillimetre,
            .droop = spindle.droop_nmm_per_krpm() * kTorquePerKrpm,
            .drag = spindle.drag_nmm_per_krpm() * kTorquePerKrpm};
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
    return configs;
}

}  // namespace bonemill
