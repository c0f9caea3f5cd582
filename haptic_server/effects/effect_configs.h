// What a scene asks of the tick's effects, in SI. Not listed: std::nullopt, and not constructed.
#pragma once

#include <memory>
#include <optional>

#include "haptic_server/volume/bone_properties.h"
#include "haptic_server/volume/distance_field.h"
#include "haptic_server/volume/material_properties.h"

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
    MaterialTable materials;
    std::shared_ptr<const DistanceField> protected_field;  // null: no effect asks for it

    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
};

}  // namespace bonemill
