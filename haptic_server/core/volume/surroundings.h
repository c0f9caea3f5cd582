// The bone around the part of it that is milled: it is seen, but neither felt nor milled.
#pragma once

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct Surroundings {
    VoxelVolume volume;          // the scan, with its own voxels
    Pose X_VS;                   // V is the frame of the bone that is milled, S that of this volume
    Eigen::AlignedBox3d milled;  // V, m: what this volume holds in there is not shown
    Eigen::AlignedBox3d bone;    // V, m: all its bone lies in there
};

}  // namespace bonemill
