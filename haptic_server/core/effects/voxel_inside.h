// A point on the bone's surface belongs to this voxel. It is RT-safe.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {

// Returns the voxel whose centre is nearest to a place half a voxel inside of the surface at p_V (m) with
// outward normal n_V (unit, or zero where it is not known): its index on one axis,
inline int voxelInside(float p_V, float n_V, float spacing) noexcept {
    const float place = p_V / spacing - 0.5f * n_V;
    constexpr float kFar = 1e6f;  // voxels: what an int holds
    return floorIndex(std::min(std::max(place + 0.5f, -kFar), kFar));
}
// and on all of them.
inline Eigen::Vector3i voxelInside(const Eigen::Vector3f& p_V, const Eigen::Vector3f& n_V,
                                   const Eigen::Vector3f& spacing) noexcept {
    return {voxelInside(p_V.x(), n_V.x(), spacing.x()), voxelInside(p_V.y(), n_V.y(), spacing.y()),
            voxelInside(p_V.z(), n_V.z(), spacing.z())};
}

}  // namespace bonemill
