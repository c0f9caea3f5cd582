// These lines tell how the scene's task stands, or what the last attempt came to. The functions are pure; any
// thread may call them.
#pragma once

#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// The time that is left, each kind of zone in one line, and one on the gates; a result names those that are
// broken, the first few of them.
std::vector<HudRow> taskStateRows(const topics::TaskState& task);
// All of it in one line, where there is no room for more.
HudRow taskSummaryRow(const topics::TaskState& task);

}  // namespace bonemill
