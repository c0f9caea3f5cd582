// Makes the tool's distance grid and its surface of what the scene says of the tool. It is for start-up only,
// since it allocates and throws.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/tool/tool_model.h"
#include "haptic_server/scene/tool_build/surface.h"
#include "haptic_server/scene/tool_build/tool_config.h"

namespace bonemill {

struct BuiltTool {
    ToolModel model;
    std::vector<std::string> warnings;  // for people: what the user would better change in the scene
};

// Computes the distances at all nodes, exact for one shape or a mesh; a union of shapes is exact outside of
// them and not deeper than true inside. Where config gives no origin, the grid is centred on the tool's box
// in x and z, and its first node lies kBurrMarginSpacings below the burr end in y; the shaft may leave it at
// the far end. Throws UserError for a bad config or mesh, and for a tool that no node lies inside.
//
// `refinements` asks for further grids, with nodes that many times as dense; each is > 1, ascending.
BuiltTool buildTool(const ToolConfig& config, const std::vector<int>& refinements = {});
inline constexpr double kBurrMarginSpacings = 3;

// Returns config.shapes, or if there are none (and no mesh) the thesis' tool: the burr, and a shaft of 0.8
// times its radius that leaves the grid at the far end.
std::vector<ToolShape> toolShapes(const ToolConfig& config);

// Returns what to draw; throws as buildTool does for a bad config or mesh.
TriangleSurface toolSurface(const ToolConfig& config);

}  // namespace bonemill
