// A scene asks this of the tick's effects, in SI. This is where each effect is declared: its name, what it
// writes into the record of a tick, its parameters, and its place in the order in which the effects act.
// Defaults and ranges stand in proto/scene.proto alone; setup/scene_effects.cpp makes a config of a scene's
// message, make_effects.cpp an effect of a config.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/effects/heat_config.h"
#include "haptic_server/core/telemetry/recorded_effects.h"
#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/distance_field.h"
#include "haptic_server/core/volume/material_properties.h"

namespace bonemill {

// Every config has kName, as in the scene's `effects` (but for material_stiffness, which follows from the
// scene's materials), and kRecords.

struct SpindleConfig {
    static constexpr const char* kName = "spindle";
    static constexpr RecordedEffects kRecords{.burr = true};
    double inertia;     // J, kg·m²
    double max_torque;  // T, N·m
    double droop;       // k, N·m·s/rad: torque per speed that is missing
    double drag;        // c, N·m·s/rad
};

// By the materials' stiffness_factor; needs EffectConfigs::properties.
struct MaterialStiffnessConfig {
    static constexpr const char* kName = "material_stiffness";
    static constexpr RecordedEffects kRecords{};
};

struct EnergyRemovalConfig {
    static constexpr const char* kName = "energy_removal";
    static constexpr RecordedEffects kRecords{.burr = true};
    double specific_energy;        // u_ref, J/m³: of bone of the reference density
    double reference_density;      // counts
    double density_exponent;       // other than 0 it needs EffectConfigs::properties
    double threshold_pressure;     // p_th, Pa
    double diamond_energy_factor;  // of u, for burrs of diamond grit
};

struct CuttingForceConfig {
    static constexpr const char* kName = "cutting_force";
    static constexpr RecordedEffects kRecords{.burr = true};
    double slow_speed;      // v_ε, m/s
    double smoothing_time;  // s
};

struct SurfaceFrictionConfig {
    static constexpr const char* kName = "surface_friction";
    static constexpr RecordedEffects kRecords{};
    double coefficient;           // μ
    double presliding_stiffness;  // N/m
};

struct BurrVibrationConfig {
    static constexpr const char* kName = "burr_vibration";
    static constexpr RecordedEffects kRecords{.burr = true};
    double amplitude_per_force;  // N per N of cutting force μ_c Σ F
    double max_amplitude;        // N
    double diamond_factor;       // of both, for burrs of diamond grit
};

// This needs EffectConfigs::protected_field.
struct VirtualFixtureConfig {
    static constexpr const char* kName = "virtual_fixture";
    static constexpr RecordedEffects kRecords{};
    double distance;          // m, of the burr's surface
    double stiffness;         // N/m
    double max_force;         // N
    double hand_force_scale;  // 0 .. 1
};

// It removes at a rate of density, by the thesis' law.
struct TimeRemovalConfig {
    static constexpr const char* kName = "time_removal";
    static constexpr RecordedEffects kRecords{};
    double rate;  // density counts/s
};

struct AddMaterialConfig {
    static constexpr const char* kName = "add_material";
    static constexpr RecordedEffects kRecords{};
    double rate;  // density counts/s
};

struct ThermalConfig {
    static constexpr const char* kName = "thermal";
    static constexpr RecordedEffects kRecords{.burr = true, .heat = true};
    double heat_share;         // of the cutting power
    double irrigation_radius;  // m
    HeatConfig heat;
};

// Needs materials with is_protected, and EffectConfigs::protected_field.
struct ProtectedStructuresConfig {
    static constexpr const char* kName = "protected_structures";
    static constexpr RecordedEffects kRecords{.protection = true};
    double warning_distance;  // m
};

// The effects of a scene; one that is not listed is std::nullopt, and is not constructed.
struct EffectConfigs {
    std::shared_ptr<const BoneProperties> properties;  // null: no effect asks for it
    MaterialTable materials;
    std::shared_ptr<const DistanceField> protected_field;  // null: no effect asks for it

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

// Calls visit(std::optional<Config>&) for each effect, in the order in which they act. Configs is
// EffectConfigs, const or not.
template <class Configs, class Visit>
void forEachEffect(Configs& configs, Visit&& visit) {
    visit(configs.spindle);
    visit(configs.material_stiffness);
    visit(configs.energy_removal);
    visit(configs.cutting_force);
    visit(configs.surface_friction);
    visit(configs.burr_vibration);
    visit(configs.virtual_fixture);
    visit(configs.time_removal);
    visit(configs.add_material);
    visit(configs.thermal);
    visit(configs.protected_structures);
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

// Returns what the effects that are listed write into the record of a tick.
inline RecordedEffects recordedBy(const EffectConfigs& configs) noexcept {
    RecordedEffects recorded;
    forEachEffect(configs, [&]<class Config>(const std::optional<Config>& config) {
        if (config) recorded.include(Config::kRecords);
    });
    return recorded;
}

}  // namespace bonemill
