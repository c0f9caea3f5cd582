// What a scene asks of the tick's effects, in SI. Not listed: std::nullopt, and not constructed.
#pragma once

#include <memory>
#include <optional>

#include "haptic_server/effects/heat_config.h"
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

// Needs materials with is_protected, and EffectConfigs::protected_field.
struct ProtectedStructuresConfig {
    double warning_distance = 2e-3;  // m
};

// Needs EffectConfigs::protected_field.
struct VirtualFixtureConfig {
    double distance = 1e-3;       // m, of the burr's surface
    double stiffness = 2000;      // N/m
    double max_force = 10;        // N
    double hand_force_scale = 1;  // 0 .. 1
};

struct ThermalConfig {
    double heat_share = 0.5;           // of the cutting power
    double irrigation_radius = 10e-3;  // m
    HeatConfig heat;
};

struct EffectConfigs {
    std::shared_ptr<const BoneProperties> properties;  // null: no effect asks for it
    MaterialTable materials;
    std::shared_ptr<const DistanceField> protected_field;  // null: no effect asks for it

    std::optional<VirtualFixtureConfig> virtual_fixture;
    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
    std::optional<ThermalConfig> thermal;
    std::optional<ProtectedStructuresConfig> protected_structures;
};

}  // namespace bonemill
