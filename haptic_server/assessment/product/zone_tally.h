// Counts what is gone of each zone.
//
// A voxel was bone if its scanned density is at or above the iso-value, and is gone if it is below now.
// Beside that, r = clip((before - now) / before, 0, 1) of what was bone tells how much of its density went.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judged_task.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct ZoneCount {
    int64_t bone = 0;         // voxels that were bone
    int64_t removed = 0;      // of these, voxels that are gone
    double density_gone = 0;  // sum of r, voxels
};

struct ProductCounts {
    std::vector<ZoneCount> zones;  // by ZoneId: the first is what is in no zone
    int64_t ideal = 0;             // bone that shall be gone
    int64_t ideal_removed = 0;     // of that, what is gone
    IndexBox changed;              // around all that is gone or shall be

    int64_t removed() const noexcept;
};

// Neither volume may be written meanwhile. It takes one look at each voxel of both.
ProductCounts countProduct(const VoxelVolume& scanned, const VoxelVolume& now, const JudgedTask& task);

// Adds the figures "zone.*", those of each role ("target.*", ...), "outside.*" and "overlap.*".
void addZoneFigures(const ProductCounts& counts, const JudgedTask& task, double voxel_volume,
                    Figures& figures);

}  // namespace bonemill
