// Does what a scene says of its task fit together?
#pragma once

#include "common/config/material_check.h"

namespace bonemill {

inline constexpr int kMaxZones = 32;
inline constexpr int kMaxTaskRules = 64;  // gates, and sub-scores

// It knows how figures are named, and which zones and structures there are, but not which figures are
// measured.
void checkTask(const scene::Scene& scene, const RefuseField& refuse);

}  // namespace bonemill
