// These are the lines that tell of the device in the hand. The functions are pure; any thread may call them.
#pragma once

#include <vector>

#include "proto/topics.pb.h"
#include "render_client/hud/hud.h"

namespace bonemill {

// The first row has the device's name and its state; in a stop the others say why, and what to do. `tool`,
// which is newer than `device`, has the last word on the state; it may be null.
std::vector<HudRow> deviceRows(const topics::Device& device, const topics::ToolState* tool);

}  // namespace bonemill
