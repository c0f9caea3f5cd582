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

struct EnergyRemovalConfig {
    double specific_energy = 0.5e9;          // u_ref, J/m³: of bone of the reference density
    double reference_density = kMaxDensity;  // counts
    double density_exponent = 0;             // needs EffectConfigs::properties
    double threshold_pressure = 0;           // p_th, Pa
    double diamond_energy_factor = 2.5;      // of u, for burrs of diamond grit
};

struct EffectConfigs {
    std::shared_ptr<const BoneProperties> properties;  // null: no effect asks for it
    MaterialTable materials;
    std::shared_ptr<const DistanceField> protected_field;  // null: no effect asks for it

    std::optional<EnergyRemovalConfig> energy_removal;
    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
};

}  // namespace bonemill
