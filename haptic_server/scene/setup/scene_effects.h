// Reads what the scene's effects, materials and tools ask of the tick's effects. It is for start-up only.
#pragma once

#include "common/config/scene_file.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/scans/densify/densify.h"

namespace bonemill {

Burr burrOf(const scene::Tool& tool);

// The configuration lacks what depends on the volume.
EffectConfigs effectConfigsOf(const scene::Scene& scene);

// This is what traces, reports and hashes hold of these effects.
RecordedEffects recordedEffectsOf(const scene::Effects& effects);

// Raw values of the scene become densities. Throws UserError for one that is none.
void mapRawValues(EffectConfigs& configs, const LoadedScene& loaded, const DensityMapping& mapping);

}  // namespace bonemill
