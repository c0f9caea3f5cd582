// The effects have the figures that the tests count on. They are those of a scene that lists the effect and
// says no more (tests/unit/haptic_server/scene/setup/scene_burr_effects_test.cpp), but that bone is equally
// hard at any density.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"

namespace bonemill::test {

inline constexpr SpindleConfig kSpindle{.inertia = 5e-7, .max_torque = 0.02, .droop = 4.8e-5, .drag = 1.9e-7};
inline constexpr EnergyRemovalConfig kEnergyRemoval{.specific_energy = 0.4e9,
                                                    .reference_density = kMaxDensity,
                                                    .density_exponent = 0,
                                                    .threshold_pressure = 0,
                                                    .diamond_energy_factor = 2,
                                                    .drill_energy_factor = 0.25,
                                                    .diamond_edge = 0.3e6,
                                                    .fluted_edge = 2e3,
                                                    .drill_edge = 15e3};
// All force cuts: for the closed forms of what is cut.
inline constexpr EnergyRemovalConfig kSharpRemoval{.specific_energy = 0.5e9,
                                                   .reference_density = kMaxDensity,
                                                   .density_exponent = 0,
                                                   .threshold_pressure = 0,
                                                   .diamond_energy_factor = 2.5,
                                                   .drill_energy_factor = 1,
                                                   .diamond_edge = 0,
                                                   .fluted_edge = 0,
                                                   .drill_edge = 0};
inline constexpr CuttingForceConfig kCuttingForce{.slow_speed = 0.01, .smoothing_time = 2e-3};
inline constexpr SurfaceFrictionConfig kSurfaceFriction{.coefficient = 0.2, .presliding_stiffness = 5e4};
inline constexpr BurrVibrationConfig kBurrVibration{
    .amplitude_per_force = 0.05, .max_amplitude = 0.5, .diamond_factor = 0.3};
inline constexpr VirtualFixtureConfig kVirtualFixture{
    .distance = 1e-3, .stiffness = 2000, .max_force = 10, .hand_force_scale = 1};
// Bone goes from full to nothing, and from nothing to full, in 20 ms.
inline constexpr TimeRemovalConfig kTimeRemoval{.rate = 12750 * kDensityCountsPerUnit};
inline constexpr AddMaterialConfig kAddMaterial{.rate = 12750 * kDensityCountsPerUnit};
inline constexpr HeatConfig kHeat{.cell = 0.5e-3,
                                  .conductivity = 0.55,
                                  .heat_capacity = 2.4e6,
                                  .perfusion = 0,
                                  .body_temperature = 37,
                                  .wet_transfer = 2000,
                                  .irrigation_temperature = 22,
                                  .dry_transfer = 10,
                                  .necrosis_temperature = 47,
                                  .necrosis_time = 0};
inline const ThermalConfig kThermal{.heat_share = 0.2,
                                    .rubbing_heat_share = 0.05,
                                    .diamond_rubbing_heat_share = 0.15,
                                    .drill_rubbing_heat_share = 0.15,
                                    .irrigation_radius = 10e-3,
                                    .heat = kHeat};
inline constexpr ProtectedStructuresConfig kProtectedStructures{.warning_distance = 2e-3};

}  // namespace bonemill::test
