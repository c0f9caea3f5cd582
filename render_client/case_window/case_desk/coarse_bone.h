// A coarse surface of the bone, to look at all of it at once. Any thread may call it.
#pragma once

#include <vector>

#include "common/geometry/node_mesh.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Returns node meshes (V, m) of a volume whose cells are so much larger that the longest edge has at most
// `most_cells` of them, or of the volume itself where it is small.
std::vector<NodeMesh> coarseBone(const VoxelVolume& volume, int most_cells = 176);

}  // namespace bonemill
