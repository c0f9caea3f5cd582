#include "render_client/look/hud/burr_work.h"

#include "common/device_messages/device_messages.h"

namespace bonemill {

BurrWork burrWorkOf(const topics::ToolState& tool) {
    if (tool.waits_for_release()) return BurrWork::kIdle;
    if (tool.buttons() & kButtonRemove) return BurrWork::kRemoving;
    return tool.buttons() & kButtonAdd ? BurrWork::kAdding : BurrWork::kIdle;
}

}  // namespace bonemill
