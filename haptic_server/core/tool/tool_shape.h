// Solid shapes a tool is made of, and their exact signed distances.
//
// The frame is T, the unit m; it is negative inside. The other functions take checked shapes
// (tool_build/build_tool.h) only. It is not for the tick. Formulas: a solid of revolution's distance is that
// of its profile in the half-plane (along the axis, off the axis).
#pragma once

#include <variant>

#include "common/geometry/pose.h"

namespace bonemill {

// Defaults as in message Tool of proto/scene.proto.
struct SphereShape {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 1.0e-3;
};
struct CapsuleShape {  // all points within `radius` of the segment
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    double radius = 0.8e-3;
};
// Scenes round edges off by this radius: a sharp edge touches a face in a line that no sampling of the bone
// carries (docs/reference/tool.md).
inline constexpr double kEdgeRadius = 0.1e-3;  // m

struct CylinderShape {  // flat ends
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    double radius = 0.8e-3;
    double edge_radius = 0;  // at most, where ends and side meet; see insideEdges()
};
struct ConeShape {  // truncated, flat ends; one of the radii may be zero
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    double from_radius = 0.8e-3;
    double to_radius = 0.4e-3;
    double edge_radius = 0;
};
using ToolShape = std::variant<SphereShape, CapsuleShape, CylinderShape, ConeShape>;

double signedDistance(const ToolShape& shape, const Eigen::Vector3d& p_T);

inline ConeShape asCone(const CylinderShape& s) {
    return {s.from, s.to, s.radius, s.radius, s.edge_radius};
}

// All points within `edge_radius` of the sharp cone that is returned make up the shape with its rounded
// edges. The edges are as round as asked for, but no rounder than leaves something of each flat end and of
// the side; a tip loses at most the length asked for.
ConeShape insideEdges(const ConeShape& shape);

// This is the tight axis-parallel box of the shape with sharp edges.
Eigen::AlignedBox3d boundingBox(const ToolShape& shape);

}  // namespace bonemill
