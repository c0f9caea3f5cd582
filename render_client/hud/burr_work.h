// What the burr does to the bone, as the tool's buttons say. Pure function, any thread.
#pragma once

#include "proto/topics.pb.h"

namespace bonemill {

enum class BurrWork { kIdle, kRemoving, kAdding };

// It removes while both buttons are down.
BurrWork burrWorkOf(const topics::ToolState& tool);

}  // namespace bonemill
