// Is the surface closed, welded as welded_mesh.h does it, and what does it enclose? For tests and reports;
// not RT-safe, thread-safe.
#pragma once

#include <cstddef>
#include <span>

#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

struct MeshCheck {
    size_t triangles = 0;
    size_t vertices = 0;           // distinct points over all leaves
    size_t open_edges = 0;         // with one triangle
    size_t crowded_edges = 0;      // with more than two
    size_t misoriented_edges = 0;  // with two triangles that run along it the same way
    double volume = 0;  // m³ enclosed; positive when triangles are counter-clockwise seen from outside

    // Every edge joins exactly two triangles of the same orientation, also across leaves.
    bool isClosed() const noexcept { return open_edges + crowded_edges + misoriented_edges == 0; }
};

MeshCheck checkMesh(std::span<const NodeMesh> meshes, const MeshGrid& grid);

// Returns the signed volume only, in m³, by the divergence theorem over the triangles; it has a meaning for a
// closed surface.
double meshVolume(std::span<const NodeMesh> meshes, const MeshGrid& grid);

}  // namespace bonemill
