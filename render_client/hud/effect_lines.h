// What the effects of a scene tell, in words. Pure functions, any thread.
#pragma once

#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/hud/hud.h"

namespace bonemill {

// Only what the scene's effects say. events: EffectState.Event bits that are shown now; info: names of
// materials.
std::vector<HudRow> effectRows(const topics::EffectState& state, const topics::SceneInfo* info,
                               uint32_t events);

// What must not be overseen: protected structures and heat. structure: as EffectState.event_id.
std::optional<HudNotice> effectAlert(uint32_t events, uint32_t structure, const topics::SceneInfo* info);

// How careful the session was so far; warnings last.
std::vector<HudRow> trainingRows(const topics::Training& training);

// "facial nerve"; what has no name by its number.
std::string structureName(uint32_t protected_id, const topics::SceneInfo* info);

}  // namespace bonemill
