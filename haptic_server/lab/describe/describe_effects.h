// Tells people what a scene's effects are and cost.
#pragma once

#include <string>

#include "haptic_server/lab/describe/effect_cost.h"
#include "proto/scene.pb.h"

namespace bonemill {

// There is one line per effect that is listed: its parameters, and for those of the tick what they add to it,
// for those of the viewer that they are. `costs` is null if nothing was measured.
std::string describeEffects(const scene::Scene& scene, const EffectCosts* costs);

}  // namespace bonemill
