// What a scene asks of the tick's effects, in SI. Not listed: std::nullopt, and not constructed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/volume/bone_properties.h"

namespace bonemill {

// A rate of density: the thesis' law.
struct TimeRemovalConfig {
    double rate = 12750 * kDensityCountsPerUnit;  // density counts/s; default: from full to nothing in 20 ms
};
struct AddMaterialConfig {
    double rate = 12750 * kDensityCountsPerUnit;  // density counts/s
};

struct EffectConfigs {
    std::shared_ptr<const BoneProperties> properties;  // null: no effect asks for it

    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
};

// Calls visit(name as in the scene, std::optional<Config>&) for each effect, in the order in which they act.
// Configs: EffectConfigs, const or not.
template <class Configs, class Visit>
void forEachEffect(Configs& configs, Visit&& visit) {
    visit("time_removal", configs.time_removal);
    visit("add_material", configs.add_material);
}

// Of those that are listed. Allocates; start-up only.
inline std::vector<std::string> effectNames(const EffectConfigs& configs) {
    std::vector<std::string> names;
    forEachEffect(configs, [&](const char* name, const auto& config) {
        if (config) names.push_back(name);
    });
    return names;
}
inline EffectConfigs withoutEffect(EffectConfigs configs, const std::string& which) {
    forEachEffect(configs, [&](const char* name, auto& config) {
        if (name == which) config.reset();
    });
    return configs;
}

}  // namespace bonemill
