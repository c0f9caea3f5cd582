// Heat of cutting in the bone, as a scene asks for it and as ticks tell of it (thermal.cpp).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "haptic_server/core/effects/effect_declaration.h"
#include "haptic_server/core/tool/burr.h"

namespace bonemill {

// It says how heat spreads in bone and leaves it, in SI; temperatures are in °C. The defaults
// stand in proto/scene.proto.
struct HeatConfig {
    double cell;           // m: edge of the cubes
    double conductivity;   // W/(m·K)
    double heat_capacity;  // J/(m³·K)
    double perfusion;      // 1/s
    double body_temperature;
    double wet_transfer;  // W/(m²·K), of irrigated surface
    double irrigation_temperature;
    double dry_transfer;  // W/(m²·K), of all other surface
    double necrosis_temperature;
    double necrosis_time;  // s above it without a break
};

struct ThermalConfig {
    static constexpr const char* kName = "thermal";
    static constexpr RecordedEffects kRecords{.burr = true, .heat = true};
    static constexpr EffectFigure kFigures[] = {
        {"temperature_c",
         "degC",
         "of the hottest bone",
         [](const EffectRecord& r) -> ColumnValue { return r.temperature; },
         {RunSummary::kLargest, "temperature_max_c", "hottest bone"},
         {"\u00b0C"}},
        {"necrotic_mm3",
         "mm^3",
         "dead bone in all",
         [](const EffectRecord& r) -> ColumnValue { return double(r.necrotic_volume) * kPerCubicMillimetre; },
         {RunSummary::kLast, "necrotic_mm3"}},
    };
    static constexpr auto parameters() {
        using C = ThermalConfig;
        return std::to_array<EffectParameter<C>>({
            {"heat_share", [](C& c, double v) { c.heat_share = v; }},
            {"rubbing_heat_share", [](C& c, double v) { c.rubbing_heat_share = v; }},
            {"diamond_rubbing_heat_share", [](C& c, double v) { c.diamond_rubbing_heat_share = v; }},
            {"drill_rubbing_heat_share", [](C& c, double v) { c.drill_rubbing_heat_share = v; }},
            {"irrigation_radius_mm", [](C& c, double v) { c.irrigation_radius = v * kMillimetre; }},
            {"cell_mm", [](C& c, double v) { c.heat.cell = v * kMillimetre; }},
            {"conductivity_w_per_m_k", [](C& c, double v) { c.heat.conductivity = v; }},
            {"heat_capacity_j_per_cm3_k",
             [](C& c, double v) { c.heat.heat_capacity = v * kPerCubicCentimetre; }},
            {"perfusion_per_s", [](C& c, double v) { c.heat.perfusion = v; }},
            {"body_temperature_c", [](C& c, double v) { c.heat.body_temperature = v; }},
            {"irrigation_w_per_m2_k", [](C& c, double v) { c.heat.wet_transfer = v; }},
            {"irrigation_temperature_c", [](C& c, double v) { c.heat.irrigation_temperature = v; }},
            {"dry_w_per_m2_k", [](C& c, double v) { c.heat.dry_transfer = v; }},
            {"necrosis_temperature_c", [](C& c, double v) { c.heat.necrosis_temperature = v; }},
            {"necrosis_time_s", [](C& c, double v) { c.heat.necrosis_time = v; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    // Of the power that rubs, what goes into the bone.
    double rubbingShare(BurrGrit grit) const noexcept {
        if (grit == BurrGrit::kDiamond) return diamond_rubbing_heat_share;
        return grit == BurrGrit::kDrill ? drill_rubbing_heat_share : rubbing_heat_share;
    }

    double heat_share;                      // of the power that cuts
    double rubbing_heat_share;              // of the power that rubs, of a burr's edges
    double diamond_rubbing_heat_share;      // of grains
    double drill_rubbing_heat_share;        // of a drill in its hole
    double irrigation_radius;               // m
    std::optional<Eigen::Vector3d> p_TN{};  // m: of the nozzle; nothing: usualNozzle()
    HeatConfig heat;
};

}  // namespace bonemill
