// What a scene asks of the tick's effects, and the list of all effects: an effect is declared in its folder
// (effect_declaration.h) and has its member and its line in kEffects here. The order there is the one in
// which effects act.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "haptic_server/core/effects/add_material/add_material_config.h"
#include "haptic_server/core/effects/burr_vibration/burr_vibration_config.h"
#include "haptic_server/core/effects/cutting_force/cutting_force_config.h"
#include "haptic_server/core/effects/energy_removal/energy_removal_config.h"
#include "haptic_server/core/effects/material_stiffness/material_stiffness_config.h"
#include "haptic_server/core/effects/protected_structures/protected_structures_config.h"
#include "haptic_server/core/effects/spindle/spindle_config.h"
#include "haptic_server/core/effects/surface_friction/surface_friction_config.h"
#include "haptic_server/core/effects/thermal/thermal_config.h"
#include "haptic_server/core/effects/time_removal/time_removal_config.h"
#include "haptic_server/core/effects/virtual_fixture/virtual_fixture_config.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/distance_field.h"
#include "haptic_server/core/volume/material_properties.h"

namespace bonemill {

// The effects of a scene; one that is not listed is std::nullopt, and is not constructed.
struct EffectConfigs {
    std::shared_ptr<const BoneProperties> properties;  // null: no effect asks for it
    MaterialTable materials;
    std::shared_ptr<const DistanceField> protected_field;  // null: no effect asks for it

    std::optional<SpindleConfig> spindle;
    std::optional<MaterialStiffnessConfig> material_stiffness;
    std::optional<EnergyRemovalConfig> energy_removal;
    std::optional<CuttingForceConfig> cutting_force;
    std::optional<SurfaceFrictionConfig> surface_friction;
    std::optional<BurrVibrationConfig> burr_vibration;
    std::optional<VirtualFixtureConfig> virtual_fixture;
    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
    std::optional<ThermalConfig> thermal;
    std::optional<ProtectedStructuresConfig> protected_structures;
};

inline constexpr std::tuple kEffects{
    &EffectConfigs::spindle,         &EffectConfigs::material_stiffness,   &EffectConfigs::energy_removal,
    &EffectConfigs::cutting_force,   &EffectConfigs::surface_friction,     &EffectConfigs::burr_vibration,
    &EffectConfigs::virtual_fixture, &EffectConfigs::time_removal,         &EffectConfigs::add_material,
    &EffectConfigs::thermal,         &EffectConfigs::protected_structures,
};

// Calls visit(std::optional<Config>&) for each effect, in the order in which they act. Configs is
// EffectConfigs, const or not.
template <class Configs, class Visit>
void forEachEffect(Configs& configs, Visit&& visit) {
    std::apply([&](auto... member) { (visit(configs.*member), ...); }, kEffects);
}

template <class Config>
constexpr const char* nameOf(const std::optional<Config>&) noexcept {
    return Config::kName;
}

// The names are those of the effects that are listed. Allocates; start-up only.
inline std::vector<std::string> effectNames(const EffectConfigs& configs) {
    std::vector<std::string> names;
    forEachEffect(configs, [&](const auto& config) {
        if (config) names.push_back(nameOf(config));
    });
    return names;
}
inline EffectConfigs withoutEffect(EffectConfigs configs, const std::string& which) {
    forEachEffect(configs, [&](auto& config) {
        if (nameOf(config) == which) config.reset();
    });
    return configs;
}

}  // namespace bonemill
