// Says which voxels a burr that goes a way can reach. It is RT-safe, and pure.
#pragma once

#include "haptic_server/core/milling/burr_way.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// A way is one if the balls at its ends leave a ridge between them that is higher than this, in voxels; else
// the burr only is where it ends, which is quicker to compute.
inline BurrWay seenWay(const VoxelVolume& volume, const BurrWay& way, double burr_radius) noexcept {
    constexpr double kSeenRidge = 0.005;
    const double ridge = way.length() * way.length() / (8 * burr_radius);
    return ridge > kSeenRidge * volume.spacing().minCoeff() ? way : BurrWay(way.to());
}

// These are the writable voxels of the box around a capsule; the box is empty if the capsule is elsewhere.
inline IndexBox boxAround(const VoxelVolume& volume, const BurrWay& way, double radius) noexcept {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    const Eigen::Array3d least = way.from().cwiseMin(way.to()), most = way.from().cwiseMax(way.to());
    const Eigen::Array3d low = ((least - radius) / spacing).max(0.0).min(dims);
    const Eigen::Array3d high = ((most + radius) / spacing).max(-1.0).min(dims - 1);
    return {low.ceil().cast<int>().matrix(), high.floor().cast<int>().matrix()};
}

// The nearest point of a box of voxels has this squared distance.
inline double squaredDistance(const VoxelVolume& volume, const IndexBox& voxels,
                              const Eigen::Vector3d& p_VB) noexcept {
    const Eigen::Array3d low = volume.spacing().array() * voxels.min.cast<double>().array() - p_VB.array();
    const Eigen::Array3d high = p_VB.array() - volume.spacing().array() * voxels.max.cast<double>().array();
    return low.max(high).max(0.0).matrix().squaredNorm();
}

}  // namespace bonemill
