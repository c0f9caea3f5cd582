// Makes the voxels of a scan larger, for what is only looked at.
#pragma once

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Each voxel becomes the mean of `factor`^3, at their middle; those at the upper ends, of as many as there
// are. Integers stay integers, rounded. One that is not finite makes such a mean. Start-up only: it allocates
// the result.
RawVolume coarser(const RawVolume& scan, int factor);

}  // namespace bonemill
