// Cuts the part of a scan where the burr works out of it, and gives it voxels that are fine enough for the
// burr.
//
// The scan is taken for a cubic B-spline through its voxels (Unser, Splines, IEEE Signal Processing Magazine
// 16, 1999): smooth to the second derivative, and exact at the scan's own voxels. It makes nothing sharper
// than it was scanned: what the scanner blurred stays blurred, unless its blur is named.
//
// Lengths are in m. For start-up only: not RT-safe, it allocates the result, the scan's voxels around the
// region as float, and for each thread some slices.
#pragma once

#include <Eigen/Geometry>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// The grid has cubes of `voxel` along the scan's axes. It covers the box (W; the smallest one along those
// axes that holds it) as far as the centres of the scan's outermost voxels. Its dims are 0 where box and scan
// do not meet.
VolumeGeometry regionGeometry(const VolumeGeometry& scan, const Eigen::AlignedBox3d& box_W, double voxel);

// The value at each voxel of the region. The scan's values are taken within the band, and stay there unless a
// blur is taken back; whole numbers stay whole. NaN counts as the band's lower end. `blur` (m) is the
// standard deviation of the scanner's blur: it is taken back to first order before, which raises the noise;
// 0: it stays.
RawVolume resampleRegion(const RawVolume& scan, const VolumeGeometry& region, const ValueRange& band,
                         double blur = 0);

}  // namespace bonemill
