// Writes the bone's surface as a file for anyone outside, in frame W and mm. It is not RT-safe.
#pragma once

#include <span>
#include <string>

#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

// Both throw UserError when the file cannot be written.

// Binary STL: all triangles. Points shared by several leaves become bit-identical coordinates, so a reader
// that merges equal points gets a closed surface.
void saveStl(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV);
// Binary little-endian PLY: welded vertices (x, y, z, normal; float) and triangles.
void savePly(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV);

}  // namespace bonemill
