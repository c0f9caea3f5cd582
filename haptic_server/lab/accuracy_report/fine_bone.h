// Makes a part of the bone with denser voxels and the same surface.
#pragma once

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Holds the voxels of `box` (indices -1 .. dims, both ends included) and `times` - 1 further ones between any
// two neighbours per axis, with the trilinear density: the trilinear iso-surface stays the same but for
// rounding, at the same place in W. What leaves the box ends at the new volume's border of air.
VoxelVolume refinedPart(const VoxelVolume& volume, const IndexBox& box, int times);

// How many voxels refinedPart() would make.
size_t refinedCount(const IndexBox& box, int times);

// This is the largest refinement 1 .. `most` with at most `room` voxels.
int affordableRefinement(const IndexBox& box, int most, size_t room);

// These are the voxels around a box of positions in V (m) grown by `margin`, cut to what can be read.
IndexBox voxelsAround(const VoxelVolume& volume, const Eigen::AlignedBox3d& box_V, double margin);

}  // namespace bonemill
