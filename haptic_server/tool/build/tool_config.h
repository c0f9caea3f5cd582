// What the tool is, in SI and frame T: the scene's message Tool without Protobuf. Same defaults as
// proto/scene.proto.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "haptic_server/tool/tool_shape.h"

namespace bonemill {

struct ToolConfig {
    std::vector<ToolShape> shapes;  // their union; none and no mesh: burr sphere and shaft (toolShapes)
    std::filesystem::path
        mesh_path;  // instead of shapes: a closed .stl or .obj in mm; as the process can open it
    double burr_radius = 1.0e-3;  // m; what cuts: a sphere at T's origin
    Eigen::Vector3i sdf_nodes{22, 128, 22};
    double sdf_spacing = 0.125e-3;                // m
    std::optional<Eigen::Vector3d> sdf_origin_T;  // m, node (0,0,0); not given: around the tool (buildTool)
};

}  // namespace bonemill
