// The help page says what mouse and keys do. It is for any thread.
#pragma once

#include <vector>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// The session's tool is none of the mouse's business, could be held by it, is held by it, or is a
// recording's.
enum class HelpFor { kLooking, kMayHold, kHolding, kReplay };

// Returns the mouse, then every key and sign of the table that is of use, by what they are for. Keys that do
// the same are one row, parted by spaces. Those of a lesson are among them where the server gives one.
std::vector<HelpGroup> helpGroups(HelpFor whom, bool has_lesson = false);

// Returns where help and panel are, for a hint over the first pictures.
std::vector<HudRow> startRows();

// Returns how the bone is looked at, and that the mouse draws, where that is not the usual way, each with the
// key that leaves it: "Cut Y on (Y: off)".
std::vector<std::string> modeTexts(const ViewSettings& settings, bool is_drawing = false);

// Returns in short what mouse and keys do to the tool that they hold, for a hint over the picture.
std::vector<HudRow> hintRows();

}  // namespace bonemill
