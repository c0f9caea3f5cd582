// Materials are as stiff as their stiffness_factor says (material_stiffness.cpp). No field of `effects` lists
// this effect: it is there where a material has a factor. Needs EffectConfigs::properties.
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct MaterialStiffnessConfig {
    static constexpr const char* kName = "material_stiffness";
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;
};

}  // namespace bonemill
