// What a scene asks of the tick's effects, in SI. Not listed: std::nullopt, and not constructed.
#pragma once

#include <memory>
#include <optional>

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

}  // namespace bonemill
