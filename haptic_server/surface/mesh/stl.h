// Writes the bone's surface as a binary STL file, for anyone outside.
#pragma once

#include <span>
#include <string>

#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

// Writes all triangles in frame W, in mm. Points shared by several leaves become bit-identical coordinates,
// so a reader that merges equal points gets a closed surface. Throws UserError when the file cannot be
// written. It is not RT-safe.
void saveStl(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV);

}  // namespace bonemill
