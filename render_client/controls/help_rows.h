// The help page says what mouse and keys do. It is for any thread.
#pragma once

#include <vector>

#include "render_client/hud/hud.h"

namespace bonemill {

// Returns the mouse, then every key and sign of the table. Keys that do the same are one
// row, parted by spaces.
std::vector<HudRow> helpRows();

}  // namespace bonemill
