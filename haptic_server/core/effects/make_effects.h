// This makes the effects of what a scene lists. It is for start-up only, since it allocates.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"

namespace bonemill {

struct EffectRoom {
    double dt;                   // s
    double largest_burr_radius;  // m, of all tools
    double largest_burr_reach;   // m, of all tools: Burr::reach()
    size_t most_contacts;
    size_t most_cells;   // as MillingConfig
    double longest_way;  // m, of a burr in a tick
};

// An effect may need this beside its own config.
struct EffectNeeds {
    const EffectConfigs& all;
    const BoneModel& bone;
    const EffectRoom& room;
};

// The effects stand in the order in which they act.
inline EffectList makeEffects(const EffectConfigs& configs, const BoneModel& bone, const EffectRoom& room) {
    EffectList effects;
    forEachEffect(configs, [&](const auto& config) {
        if (config) effects.push_back(config->make({configs, bone, room}));
    });
    return effects;
}

}  // namespace bonemill
