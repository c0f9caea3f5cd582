// What bone is made of just under its surface, on voxels finer than the scan's.
//
// There the scanner mixed bone with air: a resampled surface has the iso-value everywhere, as if all bone
// were soft at first. On the scan's own voxels that does not show, because a cell is taken for as hard as the
// densest of its corners, which is half a voxel away. It is the same here: a voxel of bone is made of the
// highest value within half a scan voxel per axis. What is no bone stays as it is.
//
// For start-up only: not RT-safe, it allocates twice the region's values.
#pragma once

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// `scan_spacing` is that of the voxels that `region` was resampled from, along the same axes, m. Returns the
// values of the region's voxels.
RawValues innerValues(const RawVolume& region, double iso_value, const Eigen::Vector3d& scan_spacing);

// Which material a voxel is of: of bone with something else within that reach what `inner` says, of all other
// voxels their own value, so that materials grow into each other nowhere but at the surface.
RawValues surfaceValues(const RawVolume& region, const RawValues& inner, double iso_value,
                        const Eigen::Vector3d& scan_spacing);

}  // namespace bonemill
