// Removal by energy, as a scene asks for it (energy_removal.cpp).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"
#include "haptic_server/core/volume/brick_store.h"

namespace bonemill {

struct EnergyRemovalConfig {
    static constexpr const char* kName = "energy_removal";
    static constexpr RecordedEffects kRecords{.burr = true};
    static constexpr auto parameters() {
        using C = EnergyRemovalConfig;
        return std::to_array<EffectParameter<C>>({
            {"specific_energy_j_per_mm3",
             [](C& c, double v) { c.specific_energy = v * kPerCubicMillimetre; }},
            {"density_exponent", [](C& c, double v) { c.density_exponent = v; }},
            {"threshold_pressure_mpa", [](C& c, double v) { c.threshold_pressure = v * kMega; }},
            {"diamond_energy_factor", [](C& c, double v) { c.diamond_energy_factor = v; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;
    static constexpr size_t kCellsPerContact = 250;  // one takes as long as so many milled cells

    double specific_energy;                  // u_ref, J/m³: of bone of the reference density
    double reference_density = kMaxDensity;  // counts
    double density_exponent;                 // other than 0 it needs EffectConfigs::properties
    double threshold_pressure;               // p_th, Pa
    double diamond_energy_factor;            // of u, for burrs of diamond grit
};

}  // namespace bonemill
