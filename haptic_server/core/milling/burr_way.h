// This is the way that a burr's centre goes in a tick, a straight line in V, and which voxels the burr can
// reach on it. It is RT-safe, and pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class BurrWay {
  public:
    // The burr stays here.
    explicit BurrWay(const Eigen::Vector3d& p_VB) noexcept : BurrWay(p_VB, p_VB, 0) {}
    // It goes from one place to another, of which only the last part of at most `longest` counts, in m.
    BurrWay(const Eigen::Vector3d& p_VB_from, const Eigen::Vector3d& p_VB_to, double longest) noexcept
        : to_(p_VB_to) {
        const Eigen::Vector3d way = p_VB_to - p_VB_from;
        const double length = way.norm();
        if (!(length > 0 && longest > 0)) return;
        length_ = std::min(length, longest);
        direction_ = way / length;
    }

    Eigen::Vector3d from() const noexcept { return to_ - length_ * direction_; }
    Eigen::Vector3d middle() const noexcept { return to_ - length_ / 2 * direction_; }
    const Eigen::Vector3d& to() const noexcept { return to_; }
    const Eigen::Vector3d& direction() const noexcept { return direction_; }  // unit
    double length() const noexcept { return length_; }                        // m

  private:
    Eigen::Vector3d to_;
    Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();
    double length_ = 0;
};

// A way is one if the balls at its ends leave a ridge between them that is higher than this, in voxels; else
// the burr only is where it ends, which is quicker to compute.
inline BurrWay seenWay(const VoxelVolume& volume, const BurrWay& way, double burr_radius) noexcept {
    constexpr double kSeenRidge = 0.005;
    const double ridge = way.length() * way.length() / (8 * burr_radius);
    return ridge > kSeenRidge * volume.spacing().minCoeff() ? way : BurrWay(way.to());
}

// These are the writable voxels of the box around a capsule; the box is empty if the capsule is elsewhere.
inline IndexBox boxAround(const VoxelVolume& volume, const BurrWay& way,
                          const Eigen::Array3d& reach) noexcept {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    const Eigen::Array3d least = way.from().cwiseMin(way.to()), most = way.from().cwiseMax(way.to());
    const Eigen::Array3d low = ((least - reach) / spacing).max(0.0).min(dims);
    const Eigen::Array3d high = ((most + reach) / spacing).max(-1.0).min(dims - 1);
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
