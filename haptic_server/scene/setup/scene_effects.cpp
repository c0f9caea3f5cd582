#include "haptic_server/scene/setup/scene_effects.h"

#include <algorithm>
#include <cmath>

#include "common/base/assert.h"
#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/field_unit.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

// What the scene says of one effect, if it lists it.
template <class Config>
void read(const scene::Effects& effects, std::optional<Config>& config) {
    const auto* const place = effects.GetDescriptor()->FindFieldByName(Config::kName);
    if (!place || !effects.GetReflection()->HasField(effects, place)) return;
    const google::protobuf::Message& message = effects.GetReflection()->GetMessage(effects, place);
    config.emplace();
    if constexpr (requires { Config::parameters(); })
        for (const auto& [name, set] : Config::parameters()) {
            const auto* const field = message.GetDescriptor()->FindFieldByName(name);
            BONEMILL_ASSERT(field);
            set(*config, message.GetReflection()->GetDouble(message, field));
        }
}

EffectConfigs configsOf(const scene::Effects& effects) {
    EffectConfigs configs;
    forEachEffect(configs, [&](auto& config) { read(effects, config); });
    return configs;
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
    EffectConfigs configs = configsOf(scene.effects());
    configs.materials = materialTableOf(scene);
    if (std::ranges::any_of(configs.materials, [](const auto& m) { return m.stiffness_factor != 1; }))
        configs.material_stiffness.emplace();
    return configs;
}

RecordedEffects recordedEffectsOf(const scene::Effects& effects) {
    return recordedBy(configsOf(effects));
}

void mapRawValues(EffectConfigs& configs, const LoadedScene& loaded, const DensityMapping& mapping) {
    const scene::EnergyRemoval& removal = loaded.scene.effects().energy_removal();
    if (!configs.energy_removal || !removal.has_reference_value()) return;
    const double share = (removal.reference_value() - mapping.low) / (mapping.high - mapping.low);
    const auto refuse = [&](const std::string& why) {
        const std::string path = "effects.energy_removal.reference_value";
        throw UserError(placeOf(loaded.file.string(), loaded.lines, path) + "field `" + path +
                        "` = " + numberText(removal.reference_value()) + why);
    };
    if (!(share > 0))
        refuse(" is not above the lower end of the window, " + numberText(mapping.low) +
               ", which is no bone at all");
    constexpr double kMaxTimes = 1e6;
    const double times = std::pow(share, -removal.density_exponent());
    if (!(times <= kMaxTimes && times >= 1 / kMaxTimes))
        refuse(" lets bone of the window's upper end, " + numberText(mapping.high) + ", take " +
               numberText(times) +
               " times its energy; give a value nearer to that, or a lower density_exponent");
    configs.energy_removal->reference_density = share * kMaxDensity;
}

}  // namespace bonemill
