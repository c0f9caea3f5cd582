// Finds the materials of a scan's voxels by labels, whatever grid these were drawn on, and what bone is made
// of just under its surface, on voxels finer than the scan's. For start-up only: not RT-safe, it allocates.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/labels/labels.h"

namespace bonemill {

struct ResampledLabels {
    std::vector<MaterialId> ids;  // of each voxel of the grid asked for, x fastest
    double covered = 0;           // share of its voxels that the labels' file says something of; others are 0
    bool is_exact = false;        // each voxel is one of the file
};

// A voxel is of the last rule whose labels have more than half of the eight around it, by trilinear weights,
// so that structures that overlap keep their shape each; where none has so much, of the rule of the label
// with the largest share, of two alike the larger label. Start-up only: allocates the result. Throws
// UserError, beginning with `label_file`, if they have no voxel in the grid or are no whole numbers.
ResampledLabels resampleLabels(const RawVolume& labels, std::span<const MaterialRule> rules,
                               const VolumeGeometry& grid, const std::string& label_file);

// Just under the surface the scanner mixed bone with air: a resampled surface has the iso-value everywhere,
// as if all bone were soft at first. On the scan's own voxels that does not show, because a cell is taken for
// as hard as the densest of its corners, which is half a voxel away. It is the same here: a voxel of bone is
// made of the highest value within half a scan voxel per axis. What is no bone stays as it is.
//
// `scan_spacing` is that of the voxels that `region` was resampled from, along the same axes, m. Returns the
// values of the region's voxels.
RawValues innerValues(const RawVolume& region, double iso_value, const Eigen::Vector3d& scan_spacing);

// Which material a voxel is of: of bone with something else within that reach what `inner` says, of all other
// voxels their own value, so that materials grow into each other nowhere but at the surface.
RawValues surfaceValues(const RawVolume& region, const RawValues& inner, double iso_value,
                        const Eigen::Vector3d& scan_spacing);

}  // namespace bonemill
