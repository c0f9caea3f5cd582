// Refuses tool shapes that are no solid. It is for start-up only, since it throws.
#pragma once

#include <string>

#include "haptic_server/core/tool/tool_shape.h"

namespace bonemill {

// Throws UserError unless every number is finite, radii are positive (a cone: one of them) and flat ends lie
// apart. `name`: what the message calls the shape, such as "tool.shape[2]".
void checkShape(const ToolShape& shape, const std::string& name);

}  // namespace bonemill
