// Makes triangles to draw a tool with. It is for start-up only, since it allocates.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/tool/tool_shape.h"
#include "haptic_server/scans/solid_mesh/mesh_file.h"

namespace bonemill {

struct TriangleSurface {
    std::vector<Eigen::Vector3f> positions;  // T, m
    std::vector<Eigen::Vector3f> normals;    // unit, outwards; one per position, split along sharp edges
    std::vector<uint32_t> indices;           // 3 per triangle, counter-clockwise seen from outside
};

// Each shape is closed and whole: those of a union overlap.
TriangleSurface surfaceOf(const std::vector<ToolShape>& shapes);

// It is the mesh itself, shaded smoothly across edges that bend by less than 40°.
TriangleSurface surfaceOf(const TriangleMesh& mesh);

}  // namespace bonemill
