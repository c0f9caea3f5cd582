#include "haptic_server/app/scene_effects.h"

#include <cmath>

#include "haptic_server/app/scene_materials.h"

namespace bonemill {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kRpm = 2 * M_PI / 60;  // rad/s

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
    return configs;
}

}  // namespace bonemill
