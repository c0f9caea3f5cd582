// The bone: densities of all voxels, shared between the tick (only writer) and the mesher (reader).
//
// Voxel (i, j, k) of frame I lies at V-position spacing ∘ (i, j, k) and W-position X_WV * that
// (docs/frames.md). A border of one voxel of air surrounds the data: indices -1 .. dims are readable, 0 ..
// dims-1 writable, so every surface is closed. Density 0..255 of the thesis is stored as 16 bit, 257 counts
// per unit.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "haptic_server/kernels/kernels.h"
#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

using Density = uint16_t;
inline constexpr int kDensityCountsPerUnit = 257;  // 255 units = 65535 counts
inline constexpr Density kMaxDensity = 65535;

// Box of integer indices, both ends included; empty when any min > max.
struct IndexBox {
    Eigen::Vector3i min = Eigen::Vector3i::Constant(1);
    Eigen::Vector3i max = Eigen::Vector3i::Zero();

    bool isEmpty() const noexcept { return (min.array() > max.array()).any(); }
    void include(const Eigen::Vector3i& index) noexcept {
        if (isEmpty()) {
            min = max = index;
            return;
        }
        min = min.cwiseMin(index);
        max = max.cwiseMax(index);
    }
    IndexBox grown(int steps) const noexcept { return {min.array() - steps, max.array() + steps}; }
    IndexBox clamped(const Eigen::Vector3i& low, const Eigen::Vector3i& high) const noexcept {
        return {min.cwiseMax(low), max.cwiseMin(high)};
    }
};

class VoxelVolume {
  public:
    // Air everywhere. Allocates; not RT-safe. `iso` is the density of the bone surface (counts, > 0).
    VoxelVolume(const VolumeGeometry& geometry, Density iso);

    const VolumeGeometry& geometry() const noexcept { return geometry_; }
    const Eigen::Vector3i& dims() const noexcept { return geometry_.dims; }
    const Eigen::Vector3d& spacing() const noexcept { return geometry_.spacing; }
    Density iso() const noexcept { return iso_; }
    double voxelVolume() const noexcept { return geometry_.spacing.prod(); }  // m³

    // Offset of a voxel in data(); any index in -1 .. dims.
    size_t offset(int i, int j, int k) const noexcept {
        return size_t(i + 1) + stride_y_ * size_t(j + 1) + stride_z_ * size_t(k + 1);
    }
    size_t strideY() const noexcept { return stride_y_; }
    size_t strideZ() const noexcept { return stride_z_; }

    // RT-safe; any thread may read, only the owner of the volume (the tick) writes. Acquire/release (plain
    // moves on x86) keep each voxel between the odd and the even leaf version around its write: a reader that
    // finds the same even LeafLattice::version before and after its reads saw one consistent node.
    Density at(size_t offset) const noexcept {
        return std::atomic_ref<Density>(const_cast<Density&>(density_[offset]))
            .load(std::memory_order_acquire);
    }
    Density at(int i, int j, int k) const noexcept { return at(offset(i, j, k)); }
    // Plain densities by offset, which the compiler can read many at a time. For the owner of the volume only
    // (tick thread): nobody else writes, so its reads race with nothing. Other threads use at().
    const Density* ownerData() const noexcept { return density_.data(); }
    void set(size_t offset, Density value) noexcept {
        std::atomic_ref<Density>(density_[offset]).store(value, std::memory_order_release);
    }
    void set(int i, int j, int k, Density value) noexcept { set(offset(i, j, k), value); }

    // Density gradient (counts per m, V axes) at a voxel by central differences (thesis eq 1-3 over twice the
    // distance); one-sided at the air border. Any index in -1 .. dims. RT-safe.
    Eigen::Vector3f gradient(int i, int j, int k) const noexcept;

  private:
    VolumeGeometry geometry_;
    Density iso_;
    size_t stride_y_;
    size_t stride_z_;
    Eigen::Vector3f inverse_spacing_;
    std::vector<Density> density_;  // and kRowSlack more that the kernels may read
};

}  // namespace bonemill
