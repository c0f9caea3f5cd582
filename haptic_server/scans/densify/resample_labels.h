// Finds the materials of a scan's voxels by labels, whatever grid these were drawn on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/labels/material_ids.h"

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

}  // namespace bonemill
