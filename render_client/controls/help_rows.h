// The help page says what mouse and keys do. It is for any thread.
#pragma once

#include <vector>

#include "render_client/hud/hud.h"

namespace bonemill {

// The session's tool is none of the mouse's business, could be held by it, or is held by it.
enum class HelpFor { kLooking, kMayHold, kHolding };

// Returns the mouse, then every key and sign of the table that is of use. Keys that do the same are one row,
// parted by spaces.
std::vector<HudRow> helpRows(HelpFor whom);

// Returns mouse and keys of the tool alone, for a hint over the picture.
std::vector<HudRow> holdRows();

}  // namespace bonemill
