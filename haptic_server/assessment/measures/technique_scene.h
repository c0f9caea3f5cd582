// What the measures of technique must know of the scene. Plain values, SI.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

struct TechniqueScene {
    RecordedEffects recorded;            // what the records hold
    std::vector<std::string> materials;  // names, in the scene's order
    std::vector<bool> are_protected;     // of the materials; those that are not named here are not
    std::vector<std::string> tools;      // names, in the scene's order
    // In contact, a force beyond this is too much; 0: no such limit.
    double force_limit = 0;  // N

    bool isProtected(size_t material) const {
        return material < are_protected.size() && are_protected[material];
    }
};

}  // namespace bonemill
