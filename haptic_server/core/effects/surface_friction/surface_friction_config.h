// Friction of tool on bone, as a scene asks for it (surface_friction.h).
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct SurfaceFrictionConfig {
    static constexpr const char* kName = "surface_friction";
    static constexpr auto parameters() {
        using C = SurfaceFrictionConfig;
        return std::to_array<EffectParameter<C>>({
            {"coefficient", [](C& c, double v) { c.coefficient = v; }},
            {"presliding_stiffness_n_per_mm",
             [](C& c, double v) { c.presliding_stiffness = v / kMillimetre; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    double coefficient;           // μ
    double presliding_stiffness;  // N/m
};

}  // namespace bonemill
