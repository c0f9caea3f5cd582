// These are the lines that tell of the device in the hand, and what it does with the burr. The functions are
// pure; any thread may call them.
#pragma once

#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// Says what the burr does to the bone, from the tool's buttons, what keeps it from milling, and whether there
// is bone: in the air it only turns.
enum class BurrWork { kIdle, kTurning, kRemoving, kAdding };

// It removes while both buttons are down.
BurrWork burrWorkOf(const topics::ToolState& tool);
// How hard it works, 0 to 1: all where it presses with kFullLoad.
inline constexpr double kFullLoad = 2;  // N
double burrLoadOf(const topics::ToolState& tool);

// In all of them `tool`, which is newer than `device`, has the last word on the state; it may be null.

// The rows are always the same: the device's name and its state, and how much of the scene's stiffness it is
// held with.
std::vector<HudRow> deviceRows(const topics::Device& device, const topics::ToolState* tool);
// Returns which stop it is in, why, and what to do; nothing outside of a stop.
std::optional<HudNotice> deviceStop(const topics::Device& device, const topics::ToolState* tool);
// Returns what it waits for before it engages, if the hand can do something about it.
std::optional<HudNotice> deviceWait(const topics::Device& device, const topics::ToolState* tool);

}  // namespace bonemill
