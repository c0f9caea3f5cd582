// Vibration of a burr that cuts, as a scene asks for it (burr_vibration.cpp).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct BurrVibrationConfig {
    static constexpr const char* kName = "burr_vibration";
    static constexpr RecordedEffects kRecords{.burr = true};
    static constexpr auto parameters() {
        using C = BurrVibrationConfig;
        return std::to_array<EffectParameter<C>>({
            {"amplitude_per_force", [](C& c, double v) { c.amplitude_per_force = v; }},
            {"max_amplitude_n", [](C& c, double v) { c.max_amplitude = v; }},
            {"diamond_factor", [](C& c, double v) { c.diamond_factor = v; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    static constexpr double kLowest = 50, kHighest = 400;            // Hz
    static constexpr double kSmoothing = 10e-3;                      // s
    static double frequency(double spin_speed, double dt) noexcept;  // Hz

    double amplitude_per_force;  // N per N of cutting force μ_c Σ F
    double max_amplitude;        // N
    double diamond_factor;       // of both, for burrs of diamond grit
};

}  // namespace bonemill
