// This map says where in a pool the bricks of a sparse box of voxels lie. Reading is RT-safe, from any
// thread; addBrick() allocates nothing but must not be called beside readers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

class BrickMap {
  public:
    static constexpr int kShift = 4, kEdge = 1 << kShift;
    static constexpr size_t kBrick = size_t(kEdge) * kEdge * kEdge;  // places of a brick
    static constexpr size_t kNowhere = ~size_t(0);

    // The map is of voxels 0 .. dims-1, none of which has a place. It allocates.
    explicit BrickMap(const Eigen::Vector3i& dims);

    const Eigen::Vector3i& dims() const noexcept { return dims_; }
    const Eigen::Vector3i& bricksPerAxis() const noexcept { return bricks_; }
    size_t placeCount() const noexcept { return used_ * kBrick; }

    size_t find(const Eigen::Vector3i& voxel) const noexcept {
        if ((voxel.array() < 0).any() || (voxel.array() >= dims_.array()).any()) return kNowhere;
        const Eigen::Vector3i brick(voxel.x() >> kShift, voxel.y() >> kShift, voxel.z() >> kShift);
        const uint32_t slot = slots_[placeIn(bricks_, brick)];
        return slot == kNone ? kNowhere : slot * kBrick + inBrick(voxel);
    }
    // Calls visit(place) for those of a cell's eight corners that have one.
    template <class Visit>
    void forEachCorner(const Eigen::Vector3i& cell, Visit&& visit) const noexcept {
        constexpr size_t kY = kEdge, kZ = size_t(kEdge) * kEdge;
        constexpr size_t kCorners[8] = {0, 1, kY, kY + 1, kZ, kZ + 1, kZ + kY, kZ + kY + 1};
        constexpr int kLast = kEdge - 1;
        const bool is_in_one = (cell.x() & kLast) < kLast && (cell.y() & kLast) < kLast &&
                               (cell.z() & kLast) < kLast && cell.x() + 1 < dims_.x() &&
                               cell.y() + 1 < dims_.y() && cell.z() + 1 < dims_.z();
        if (is_in_one) {
            const size_t first = find(cell);
            if (first == kNowhere) return;
            for (const size_t corner : kCorners) visit(first + corner);
            return;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const size_t place = find(cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
            if (place != kNowhere) visit(place);
        }
    }
    static size_t inBrick(const Eigen::Vector3i& voxel) noexcept {
        constexpr int kMask = kEdge - 1;
        return size_t(voxel.x() & kMask) +
               size_t(kEdge) * (size_t(voxel.y() & kMask) + size_t(kEdge) * size_t(voxel.z() & kMask));
    }
    IndexBox voxelsOf(const Eigen::Vector3i& brick) const noexcept;
    // Gives the brick the next kBrick places of the pool.
    void addBrick(const Eigen::Vector3i& brick) noexcept { slots_[placeIn(bricks_, brick)] = used_++; }

  private:
    static constexpr uint32_t kNone = ~uint32_t(0);

    Eigen::Vector3i dims_, bricks_;
    std::vector<uint32_t> slots_;
    uint32_t used_ = 0;
};

}  // namespace bonemill
