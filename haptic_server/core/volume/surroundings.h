// The bone around the part of it that is milled: it is seen, but neither felt nor milled.
#pragma once

#include "haptic_server/core/volume/region_rim.h"

namespace bonemill {

struct Surroundings {
    VoxelVolume volume;  // the scan, with its own voxels
    Pose X_VS;           // V is the frame of the bone that is milled, S that of this volume; no rotation
    Eigen::AlignedBox3d bone;  // V, m: all its bone lies in there
    RegionRim rim;  // between the two; it takes the place of this volume in the region and beside it
};

}  // namespace bonemill
