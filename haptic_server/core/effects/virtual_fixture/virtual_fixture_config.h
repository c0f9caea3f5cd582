// A region round protected structures that pushes the tool out, as a scene asks for it (virtual_fixture.cpp).
// Needs EffectConfigs::protected_field.
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct VirtualFixtureConfig {
    static constexpr const char* kName = "virtual_fixture";
    static constexpr auto parameters() {
        using C = VirtualFixtureConfig;
        return std::to_array<EffectParameter<C>>({
            {"distance_mm", [](C& c, double v) { c.distance = v * kMillimetre; }},
            {"stiffness_n_per_mm", [](C& c, double v) { c.stiffness = v / kMillimetre; }},
            {"max_force_n", [](C& c, double v) { c.max_force = v; }},
            {"hand_force_scale", [](C& c, double v) { c.hand_force_scale = v; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    double distance;          // m, of the burr's surface
    double stiffness;         // N/m
    double max_force;         // N
    double hand_force_scale;  // 0 .. 1
};

}  // namespace bonemill
