// Clears what is no bone and not near any, for it need not be kept.
//
// It is not RT-safe (it allocates) and has no shared state.
#pragma once

#include <functional>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Does is(brick) hold for this brick or one of its neighbours?
template <class Is>
bool anyBrickAround(const BrickStore& bricks, const Eigen::Vector3i& brick, Is&& is) {
    const IndexBox all = bricks.allBricks();
    bool is_any = false;
    forEachIndex(IndexBox{brick, brick}.grown(1).clamped(all.min, all.max), [&](const Eigen::Vector3i& b) {
        is_any = is_any || is(bricks.brickAt(b.x(), b.y(), b.z()));
    });
    return is_any;
}

// Does the brick own a voxel that is_kept(index, x fastest)? Without is_kept it does not.
bool ownsAny(const VoxelVolume& volume, const Eigen::Vector3i& brick,
             const std::function<bool(size_t)>& is_kept);

// Densities in bricks that hold no bone, and whose neighbours hold none, become air: soft tissue and noise at
// least 16 voxels away from all bone, which no surface and no gradient ever sees. A burr that adds bone there
// starts from air. Their memory is given back. Bricks with a voxel that is_kept(index, x fastest) stay as
// they are; by default there is none.
void clearFarFromBone(VoxelVolume& volume, const std::function<bool(size_t)>& is_kept = {});

}  // namespace bonemill
