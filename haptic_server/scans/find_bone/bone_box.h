// Where the bone of a volume lies. For start-up only: it looks at every voxel that is not air all around.
#pragma once

#include <Eigen/Geometry>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// The voxels that bone reaches to; empty without bone.
IndexBox boneBox(const VoxelVolume& volume);

// Its middle voxels' places in V, m.
Eigen::AlignedBox3d placesOf(const IndexBox& voxels, const Eigen::Vector3d& spacing);

}  // namespace bonemill
