// Brings labels onto the voxels of a scan, whatever grid they were drawn on.
#pragma once

#include <string>

#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

struct ResampledLabels {
    RawVolume labels;       // on the grid asked for
    double covered = 0;     // share of its voxels that the labels' file says something of; the others are 0
    bool is_exact = false;  // each voxel is one of the file
};

// A voxel gets the label that has the largest share of the eight around it, by trilinear weights; of two
// alike the larger one. Start-up only: allocates the result. Throws UserError, beginning with `label_file`,
// if they have no voxel in the grid or are no whole numbers.
ResampledLabels resampleLabels(const RawVolume& labels, const VolumeGeometry& grid,
                               const std::string& label_file);

}  // namespace bonemill
