// A point on the bone's surface belongs to this voxel. It is RT-safe.
#pragma once

#include <Eigen/Core>

#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {

// Returns the voxel whose centre is nearest to a place half a voxel inside of the surface at p_V (m) with
// outward normal n_V (unit, or zero where it is not known).
inline Eigen::Vector3i voxelInside(const Eigen::Vector3f& p_V, const Eigen::Vector3f& n_V,
                                   const Eigen::Vector3f& spacing) noexcept {
    const Eigen::Array3f place = p_V.array() / spacing.array() - 0.5f * n_V.array();
    constexpr float kFar = 1e6f;  // voxels: what an int holds
    return floorIndices((place + 0.5f).max(-kFar).min(kFar).matrix());
}

}  // namespace bonemill
