// Makes the tool's distance grid and its surface of what the scene says of the tool, and refuses what is no
// solid. It is for start-up only, since it allocates and throws.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/tool/tool_model.h"
#include "haptic_server/core/tool/tool_shape.h"
#include "haptic_server/scene/tool_build/surface.h"

namespace bonemill {

// Throws UserError unless every number is finite, radii are positive (a cone: one of them) and flat ends lie
// apart. `name`: what the message calls the shape, such as "tool.shape[2]".
void checkShape(const ToolShape& shape, const std::string& name);

// It says what the tool is, in SI and frame T: the scene's message Tool without Protobuf. It has the same
// defaults as proto/scene.proto.
struct ToolConfig {
    std::vector<ToolShape> shapes;  // their union; none and no mesh: burr and shaft (toolShapes)
    std::filesystem::path
        mesh_path;  // instead of shapes: a closed .stl or .obj in mm; as the process can open it
    // The burr is what cuts, around T's origin; lengths are in m.
    BurrKind burr_kind = BurrKind::kBall;
    double burr_radius = 1.0e-3;
    double burr_length = 0, burr_tip_radius = 0;  // as Burr
    Burr burr() const {
        return {
            .kind = burr_kind, .radius = burr_radius, .length = burr_length, .tip_radius = burr_tip_radius};
    }
    Eigen::Vector3i sdf_nodes{22, 128, 22};
    double sdf_spacing = 0.125e-3;                // m
    std::optional<Eigen::Vector3d> sdf_origin_T;  // m, node (0,0,0); not given: around the tool (buildTool)
};

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
