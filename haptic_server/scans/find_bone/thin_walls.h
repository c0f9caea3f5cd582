// Finds walls that the scan's voxels have blurred to below the iso-value, so that they do not vanish without
// a word.
#pragma once

#include <cstdint>
#include <optional>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// A voxel below the iso-value is of a thin wall if along one of the grid's axes it is the highest of five,
// and stands above the higher of both ends by at least half of what lies between that end and the iso-value.
// The wall's thickness is what the five hold above that end, over what bone holds above it (partial volume:
// blur keeps the sum), along the axis where it is thinnest. A rough figure: it knows no slant, and bone for
// the mean of what is above the iso-value.
struct ThinWalls {
    uint64_t voxels = 0;
    double median_thickness = 0;  // m; 0 without any
};

// Looks at the voxels of a box within the scan. Start-up only; allocates four bytes per voxel found.
ThinWalls findThinWalls(const RawVolume& scan, const IndexBox& within, double iso_value);

}  // namespace bonemill
