// These are the lines, alerts and figures of training that tell of a scene's effects. The functions are pure;
// any thread may call them.
#pragma once

#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// Both return only what the scene's effects say: how careful the trainee is, and what the motor does.
// `events` are the EffectState.Event bits that are shown now; `info` has the names of materials.
std::vector<HudRow> effectTaskRows(const topics::EffectState& state, const topics::SceneInfo* info,
                                   uint32_t events);
std::vector<HudRow> effectDetailRows(const topics::EffectState& state);

// Returns what must not be overseen: protected structures and heat. `structure` is
// numbered as EffectState.event_id.
std::optional<HudNotice> effectAlert(uint32_t events, uint32_t structure, const topics::SceneInfo* info);

// Returns how careful the session was so far; the warnings come last.
std::vector<HudRow> trainingRows(const topics::Training& training);

// Returns a name such as "facial nerve", or the number of what has no name.
std::string structureName(uint32_t protected_id, const topics::SceneInfo* info);

}  // namespace bonemill
