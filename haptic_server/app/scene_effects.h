// What the scene's effects, materials and tools ask of the tick's effects. Start-up only.
#pragma once

#include "haptic_server/effects/effect_configs.h"
#include "haptic_server/tool/burr.h"
#include "proto/scene.pb.h"

namespace bonemill {

Burr burrOf(const scene::Tool& tool);

// Fields of scene::Effects from this number on are the viewer's: they cost the tick nothing.
inline constexpr int kFirstViewerEffect = 20;

EffectConfigs effectConfigsOf(const scene::Scene& scene);

}  // namespace bonemill
