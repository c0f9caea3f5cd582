// An SPO model needs to know this of the tool in use.
#pragma once

#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/tool/tool_model.h"

namespace bonemill {

struct SpoTool {
    const ToolModel* model = nullptr;  // must outlive whoever uses the tool
    Burr burr = {};
    double saturation_force = 50;  // N: what the gradient law's coupling pulls this tool with at most
};

}  // namespace bonemill
