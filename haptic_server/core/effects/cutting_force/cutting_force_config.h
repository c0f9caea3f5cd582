// The force of cutting on the hand, as a scene asks for it (cutting_force.cpp).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct CuttingForceConfig {
    static constexpr const char* kName = "cutting_force";
    static constexpr RecordedEffects kRecords{.burr = true};
    static constexpr auto parameters() {
        using C = CuttingForceConfig;
        return std::to_array<EffectParameter<C>>({
            {"slow_speed_mm_per_s", [](C& c, double v) { c.slow_speed = v * kMillimetre; }},
            {"smoothing_time_ms", [](C& c, double v) { c.smoothing_time = v * kMillisecond; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    double slow_speed;      // v_ε, m/s
    double smoothing_time;  // s
};

}  // namespace bonemill
