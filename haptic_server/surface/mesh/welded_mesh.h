// The node meshes become one indexed surface. Vertices of different leaves are the same when they lie on the
// same integer point of the grid, which is exact and needs no tolerance. It is not RT-safe, but thread-safe.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

struct WeldedMesh {
    std::vector<Eigen::Vector3i> vertices;           // steps of the grid; ascending by x, then y, then z
    std::vector<Eigen::Vector3f> normals;            // per vertex, unit, V, out of the bone
    std::vector<std::array<uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

WeldedMesh weld(std::span<const NodeMesh> meshes, const MeshGrid& grid);

}  // namespace bonemill
