// It says what the tool is, in SI and frame T: the scene's message Tool without Protobuf. It has the same
// defaults as proto/scene.proto.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/tool/tool_shape.h"

namespace bonemill {

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

}  // namespace bonemill
