// Writes the bone's surface as a binary PLY file, for anyone outside.
#pragma once

#include <span>
#include <string>

#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

// The file is binary little endian: welded vertices (x, y, z in mm, normal; float) and triangles, frame W.
// Throws UserError when the file cannot be written. It is not RT-safe.
void savePly(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV);

}  // namespace bonemill
