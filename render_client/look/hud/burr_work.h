// Says what the burr does to the bone, from the tool's buttons and what keeps it from milling. The function
// is pure; any thread may call it.
#pragma once

#include "proto/topics.pb.h"

namespace bonemill {

enum class BurrWork { kIdle, kRemoving, kAdding };

// It removes while both buttons are down.
BurrWork burrWorkOf(const topics::ToolState& tool);

}  // namespace bonemill
