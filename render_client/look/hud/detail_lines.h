// These are the lines of the head-up display that are folded as a rule: how well the session runs, and what
// of the force and the effects does not matter to the task. The function is pure; any thread may call it.
#pragma once

#include <vector>

#include "render_client/look/hud/hud_lines.h"

namespace bonemill {

std::vector<HudRow> detailRows(const HudInput& input);

}  // namespace bonemill
