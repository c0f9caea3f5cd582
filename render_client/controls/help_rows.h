// The help page: what mouse and keys do. Any thread.
#pragma once

#include <vector>

#include "render_client/hud/hud.h"

namespace bonemill {

// Returns the mouse, then every key and sign of the table. Keys that do the same are one
// row, parted by spaces.
std::vector<HudRow> helpRows();

}  // namespace bonemill
