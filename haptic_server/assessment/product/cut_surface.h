// What an attempt has changed: voxel by voxel, and the pieces of the bone's surface around what is gone, or
// should be, which are the triangles of marching cubes, as they are drawn. The frame is V, the unit m.
#pragma once

#include <vector>

#include "haptic_server/assessment/product/judged_task.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Says of each voxel in a box what it was, is and shall be. It is read-only after construction.
class ChangeGrid {
  public:
    // Neither volume may be written meanwhile. It allocates a byte per voxel.
    ChangeGrid(const IndexBox& box, const VoxelVolume& scanned, const VoxelVolume& now,
               const JudgedTask& task);

    const IndexBox& box() const noexcept { return box_; }
    const Eigen::Vector3d& spacing() const noexcept { return spacing_; }

    // Outside of the box nothing is.
    bool wasBone(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kWasBone; }
    bool isBone(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kIsBone; }
    bool isRemoved(const Eigen::Vector3i& voxel) const noexcept {
        return (at(voxel) & (kWasBone | kIsBone)) == kWasBone;
    }
    // It was bone and shall be gone.
    bool isIdeal(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kIsIdeal; }
    // It was bone and shall stay.
    bool staysIdeally(const Eigen::Vector3i& voxel) const noexcept {
        return (at(voxel) & (kWasBone | kIsIdeal)) == kWasBone;
    }
    bool isChangedOrIdeal(const Eigen::Vector3i& voxel) const noexcept {
        return isRemoved(voxel) || isIdeal(voxel);
    }

    Eigen::Vector3i voxelOf(const Eigen::Vector3d& p_V) const noexcept {
        return (p_V.array() / spacing_.array()).round().cast<int>();
    }

  private:
    static constexpr uint8_t kWasBone = 1, kIsBone = 2, kIsIdeal = 4;

    uint8_t at(const Eigen::Vector3i& voxel) const noexcept {
        if ((voxel.array() < box_.min.array()).any() || (voxel.array() > box_.max.array()).any()) return 0;
        const Eigen::Vector3i n = voxel - box_.min;
        return bits_[size_t(n.x()) + size_t(size_.x()) * (size_t(n.y()) + size_t(size_.y()) * size_t(n.z()))];
    }

    IndexBox box_;
    Eigen::Vector3i size_;
    Eigen::Vector3d spacing_;
    std::vector<uint8_t> bits_;
};

struct CutPiece {
    Eigen::Vector3d center_V, normal_V;  // out of the bone
    double area;                         // m²
    bool is_judged;                      // something around it is removed, or should be
};

// All of the surface in the box. `now` may not be written meanwhile. It allocates.
std::vector<CutPiece> surfaceIn(const VoxelVolume& now, const ChangeGrid& changes);

}  // namespace bonemill
