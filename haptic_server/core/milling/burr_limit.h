// A burr leaves so much density: the limit of a voxel by its distance from the burr's centre. All is RT-safe.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// This is the way that a burr's centre goes in a tick, a straight line in V, and which voxels the burr can
// reach on it. It is RT-safe, and pure.
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

enum class MillingShape : uint8_t {
    kVoxelCentres,  // thesis §4.2.2: voxels whose centre is inside the burr go (or come) altogether
    // A ramp of density across the burr's surface puts the iso-surface onto it. With d the distance of the
    // voxel's centre from the burr's surface (m, positive outside) a voxel keeps at most iso + slope d when
    // removing and gets at least iso - slope d when adding, slope = min(iso, full - iso) / largest spacing:
    // both ends of a grid edge that crosses the surface lie on the ramp.
    kSubVoxel,
};

// This is the limit for one burr, one direction (-1 removes, +1 adds) and one shape. Where the burr goes in
// a tick, it is that of all its places on the way: that of the capsule.
//
// Between voxels the distance from a sphere of radius R is less than its linear interpolation, by
// Σ h_i² t_i (1 - t_i) (1 - n_i²) / (2 R) along normal n at place t in a cell with edges h_i: at most h²/(8
// R) on an edge, h²/(4 R) inside a cell. Uncorrected, the bone would reach into the burr everywhere, and a
// burr that sinks in by less than that would cut no more. The ramp is therefore that of a sphere larger by
// Σ h_i² / (8 R), half as much again as the most that it can be in a cubic cell: no bone is left inside the
// burr, which therefore moves on as soon as the rate lets it. The surface lies Σ h_i² / (14 R) outside of the
// burr on the mean: 3 µm for a burr of 1 mm and voxels of 0.125 mm.
//
// That is for burrs of two voxels and more. For any R, the mean of the distances of a cell's corners is at
// most the root of the mean of their squares, which is r² + Σ h_i² t_i (1 - t_i) for a place at distance r:
// no interpolated distance in the burr exceeds sqrt(R² + Σ h_i² / 4). A burr that removes has a sphere of at
// least this, though it may take more than its own volume, since bone that it could not cut would hold it up
// for good.
class BurrLimit {
  public:
    // The ramp ends here (in largest spacings outside the burr) also where a low or high iso-value would let
    // it go on: the work of a tick stays bounded.
    static constexpr double kMaxReach = 3;

    BurrLimit(const VoxelVolume& volume, double burr_radius, MillingShape shape, int direction) noexcept
        : radius_(burr_radius), iso_(volume.iso()) {
        const bool is_ramp = shape == MillingShape::kSubVoxel;
        if (is_ramp) {
            radius_ += ampleSag(volume, burr_radius);
            if (direction < 0) radius_ = std::max(radius_, mostInterpolated(volume, burr_radius));
        }
        const double unit = volume.spacing().maxCoeff();
        const double below = iso_;
        const double above = kMaxDensity - iso_;
        slope_ = std::max(1.0, std::min(below, above)) / unit;
        const double inside = is_ramp ? (direction < 0 ? below : above) / slope_ : 0;
        const double outside = is_ramp ? (direction < 0 ? above : below) / slope_ : 0;
        reach_ = radius_ + std::min(outside, kMaxReach * unit);
        const double core = std::max(0.0, radius_ - inside);
        core_squared_ = core * core;
    }

    // Burrs under two voxels in radius have no more of it than one of two.
    static double ampleSag(const VoxelVolume& volume, double burr_radius) noexcept {
        const double radius = std::max(burr_radius, 2 * volume.spacing().maxCoeff());
        return volume.spacing().squaredNorm() / (8 * radius);
    }

    // No place in a ball of this radius has a larger interpolated distance from its centre, m.
    static double mostInterpolated(const VoxelVolume& volume, double radius) noexcept {
        return std::sqrt(radius * radius + volume.spacing().squaredNorm() / 4);
    }

    // Voxels at this distance from the burr's centre or farther have no limit; m.
    double reach() const noexcept { return reach_; }
    // Counts per m, of the ramp across the surface.
    double slope() const noexcept { return slope_; }

    // This is the limit in a plane of voxels, as the kernels want it, of a burr that goes this way. to_first
    // leads from where it sets out to the plane's first voxel, in m.
    BurrPlane plane(const BurrWay& way, const Eigen::Vector3d& to_first, const Eigen::Vector3d& spacing,
                    int amount) const noexcept {
        return {.first_x = float(to_first.x()),
                .step_x = float(spacing.x()),
                .first_y = float(to_first.y()),
                .step_y = float(spacing.y()),
                .off_plane_squared = float(to_first.z() * to_first.z()),
                .way_x = float(way.direction().x()),
                .way_y = float(way.direction().y()),
                .off_plane_along = float(to_first.z() * way.direction().z()),
                .way = float(way.length()),
                .radius = float(radius_),
                .slope = float(slope_),
                .reach_squared = float(reach_ * reach_),
                .core_squared = float(core_squared_),
                .iso = int(iso_),
                .amount = amount};
    }

  private:
    double radius_;  // m; of the sphere on which the ramp has the iso-value
    double iso_;
    double slope_;  // counts per m
    double reach_;
    double core_squared_;
};

}  // namespace bonemill
