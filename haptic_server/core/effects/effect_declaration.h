// An effect is declared by its config, NAME/NAME_config.h: a struct in SI with
//
// - kName, as in the scene's `effects`;
// - parameters(): which field of the scene's message sets what (defaults and ranges stand in
//   proto/scene_effects.proto alone);
// - kRecords: the shared parts of the tick's record that it writes; left out: none;
// - kFigures: what it tells of its own, an array of EffectFigure; left out: nothing;
// - make(): the effect itself, at the start.
#pragma once

#include <array>
#include <memory>

#include "common/base/units.h"
#include "haptic_server/core/telemetry/effect_figure.h"

namespace bonemill {

class HapticEffect;  // haptic_effect.h
struct EffectNeeds;  // effect_host.h

template <class Config>
struct EffectParameter {
    const char* field;  // of the effect's message in proto/scene.proto, in the unit of its name
    void (*set)(Config&, double value);
};

}  // namespace bonemill
