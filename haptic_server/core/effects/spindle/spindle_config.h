// The motor that turns the burr, as a scene asks for it (spindle.cpp).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct SpindleConfig {
    static constexpr const char* kName = "spindle";
    static constexpr RecordedEffects kRecords{.burr = true};
    static constexpr auto parameters() {
        constexpr double kTorquePerKrpm = kMillimetre / (1000 * kRpm);  // N·m·s/rad
        using C = SpindleConfig;
        return std::to_array<EffectParameter<C>>({
            {"inertia_kg_mm2", [](C& c, double v) { c.inertia = v * kMillimetre * kMillimetre; }},
            {"max_torque_nmm", [](C& c, double v) { c.max_torque = v * kMillimetre; }},
            {"droop_nmm_per_krpm", [](C& c, double v) { c.droop = v * kTorquePerKrpm; }},
            {"drag_nmm_per_krpm", [](C& c, double v) { c.drag = v * kTorquePerKrpm; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;
    // Returns the speed after dt in rad/s, from the `speed` before, the `wanted` Ω₀ and dry friction of at
    // most `load` N·m.
    double speedAfter(double speed, double wanted, double load, double dt) const noexcept;

    double inertia;     // J, kg·m²
    double max_torque;  // T, N·m
    double droop;       // k, N·m·s/rad: torque per speed that is missing
    double drag;        // c, N·m·s/rad
};

}  // namespace bonemill
