// What a scene asks of the tick's effects, in SI. Not listed: std::nullopt, and not constructed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

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

struct EnergyRemovalConfig {
    double specific_energy = 0.5e9;          // u_ref, J/m³: of bone of the reference density
    double reference_density = kMaxDensity;  // counts
    double density_exponent = 0;             // needs EffectConfigs::properties
    double threshold_pressure = 0;           // p_th, Pa
    double diamond_energy_factor = 2.5;      // of u, for burrs of diamond grit
};
struct SpindleConfig {
    double inertia = 5e-7;     // J, kg·m²
    double max_torque = 0.02;  // T, N·m
    double droop = 4.8e-5;     // k, N·m·s/rad: torque per speed that is missing
    double drag = 1.9e-7;      // c, N·m·s/rad
};
struct CuttingForceConfig {
    double slow_speed = 0.01;      // v_ε, m/s
    double smoothing_time = 2e-3;  // s
};
struct BurrVibrationConfig {
    double amplitude_per_force = 0.05;  // N per N of cutting force μ_c Σ F
    double max_amplitude = 0.5;         // N
    double diamond_factor = 0.3;        // of both, for burrs of diamond grit
};
struct SurfaceFrictionConfig {
    double coefficient = 0.2;           // μ
    double presliding_stiffness = 5e4;  // N/m
};
// By the materials' stiffness_factor; needs EffectConfigs::properties.
struct MaterialStiffnessConfig {};

// Needs materials with is_protected, and EffectConfigs::protected_field.
struct ProtectedStructuresConfig {
    double warning_distance = 2e-3;  // m
};

// This needs EffectConfigs::protected_field.
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

    // In the order in which they act.
    std::optional<SpindleConfig> spindle;
    std::optional<MaterialStiffnessConfig> material_stiffness;  // where a material has a factor
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

// Calls visit(name as in the scene's `effects` but for material_stiffness, std::optional<Config>&) for each
// effect, in the order in which they act. Configs: EffectConfigs, const or not.
template <class Configs, class Visit>
void forEachEffect(Configs& configs, Visit&& visit) {
    visit("spindle", configs.spindle);
    visit("material_stiffness", configs.material_stiffness);
    visit("energy_removal", configs.energy_removal);
    visit("cutting_force", configs.cutting_force);
    visit("surface_friction", configs.surface_friction);
    visit("burr_vibration", configs.burr_vibration);
    visit("virtual_fixture", configs.virtual_fixture);
    visit("time_removal", configs.time_removal);
    visit("add_material", configs.add_material);
    visit("thermal", configs.thermal);
    visit("protected_structures", configs.protected_structures);
}

// The names are those of the effects that are listed. Allocates; start-up only.
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
