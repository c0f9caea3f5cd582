// Removal at a rate of density, by the thesis' law, as a scene asks for it (time_removal.cpp).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct TimeRemovalConfig {
    static constexpr const char* kName = "time_removal";
    static constexpr auto parameters() {
        using C = TimeRemovalConfig;
        return std::to_array<EffectParameter<C>>({
            {"rate_density_per_s", [](C& c, double v) { c.rate = v * kDensityCountsPerUnit; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    double rate;  // density counts/s
};

}  // namespace bonemill
