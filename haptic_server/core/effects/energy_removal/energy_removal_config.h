// Removal by energy, as a scene asks for it (energy_removal.cpp).
#pragma once

#include <cmath>

#include "haptic_server/core/effects/effect_declaration.h"
#include "haptic_server/core/tool/burr.h"
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
            {"drill_energy_factor", [](C& c, double v) { c.drill_energy_factor = v; }},
            {"diamond_edge_mpa", [](C& c, double v) { c.diamond_edge = v * kMega; }},
            {"fluted_edge_n_per_mm", [](C& c, double v) { c.fluted_edge = v * kPerMillimetre; }},
            {"drill_edge_n_per_mm", [](C& c, double v) { c.drill_edge = v * kPerMillimetre; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;
    // u of this burr per u of the bone.
    double energyFactor(const Burr& burr) const noexcept {
        return burr.grit == BurrGrit::kDiamond ? diamond_energy_factor
               : burr.grit == BurrGrit::kDrill ? drill_energy_factor
                                               : 1;
    }
    // p_e, Pa: what this burr carries without cutting at ρ (m, > 0) from its axis, in bone of u_ref. Edges
    // with E in a turn are so many per length there: E/(2πρ).
    double rubbingPressure(const Burr& burr, double rho) const noexcept {
        if (burr.grit == BurrGrit::kDiamond) return threshold_pressure + diamond_edge;
        const double edge = burr.grit == BurrGrit::kDrill ? drill_edge : fluted_edge;
        return threshold_pressure + edge / (2 * M_PI * rho);
    }
    static constexpr size_t kCellsPerContact = 250;  // one takes as long as so many milled cells

    double specific_energy;                  // u_ref, J/m³: of bone of the reference density
    double reference_density = kMaxDensity;  // counts
    double density_exponent;                 // other than 0 it needs EffectConfigs::properties
    double threshold_pressure;               // Pa: of wear flats
    double diamond_energy_factor;            // of u, for burrs of diamond grit
    double drill_energy_factor;              // of u, for drills
    double diamond_edge;                     // Pa: of grains
    double fluted_edge, drill_edge;          // N/m: of all edges in a turn
};

}  // namespace bonemill
