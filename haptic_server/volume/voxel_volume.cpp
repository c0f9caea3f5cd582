#include "haptic_server/volume/voxel_volume.h"

#include <cstring>

namespace bonemill {

VoxelVolume::VoxelVolume(const VolumeGeometry& geometry, Density iso)
    : geometry_(geometry),
      iso_(iso),
      inverse_spacing_(geometry.spacing.cwiseInverse().cast<float>()),
      bricks_(geometry.dims.array() + 2) {}

void VoxelVolume::readRow(const Eigen::Vector3i& first, int count, Density* out) const noexcept {
    for (int done = 0; done < count;) {
        const int i = first.x() + done;
        const int n = stretch(i, first.x() + count - 1);
        std::memcpy(out + done, ownerData() + offset(i, first.y(), first.z()), size_t(n) * sizeof(Density));
        done += n;
    }
}

bool VoxelVolume::isUniform(const Eigen::Vector3i& cell, Density& density) const noexcept {
    const BrickId brick = bricks_.brickOf(cell.x() + 1, cell.y() + 1, cell.z() + 1);
    if (!bricks_.isShared(brick)) return false;
    density = bricks_.sharedDensity(brick);
    return true;
}

IndexBox VoxelVolume::bricksHolding(const IndexBox& voxels) const noexcept {
    const auto brick = [](int index, int beside) { return (index + 1 + beside) >> kBrickShift; };
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::max(0, brick(voxels.min[axis], -kBrickHigh));
        box.max[axis] = std::min(bricks_.bricksPerAxis()[axis] - 1, brick(voxels.max[axis], kBrickLow));
    }
    return box;
}

bool VoxelVolume::hasRoomFor(const IndexBox& voxels) const noexcept {
    const IndexBox box = bricksHolding(voxels);
    size_t shared = 0;
    forEachIndex(box, [&](const Eigen::Vector3i& b) {
        const Eigen::Vector3i u = b * kBrickCells;
        shared += bricks_.isShared(bricks_.brickOf(u.x(), u.y(), u.z()));
    });
    return shared <= bricks_.spareCount();
}

void VoxelVolume::writeRow(const Eigen::Vector3i& first, int count, const Density* densities) noexcept {
    const IndexBox row{first, {first.x() + count - 1, first.y(), first.z()}};
    forEachIndex(bricksHolding(row), [&](const Eigen::Vector3i& brick) {
        const IndexBox held = voxelsIn(brick);
        const int low = std::max(first.x(), held.min.x());
        const int high = std::min(row.max.x(), held.max.x());
        writeInto(brick, {low, first.y(), first.z()}, high - low + 1, densities + (low - first.x()));
    });
}

// The part of a row that this brick holds.
void VoxelVolume::writeInto(const Eigen::Vector3i& brick, const Eigen::Vector3i& first, int count,
                            const Density* densities) noexcept {
    const Eigen::Vector3i u = brick * kBrickCells;
    const BrickId id = bricks_.brickOf(u.x(), u.y(), u.z());
    if (bricks_.isShared(id)) {
        const Density shared = bricks_.sharedDensity(id);
        if (std::all_of(densities, densities + count, [=](Density d) { return d == shared; })) return;
        bricks_.open(id);
    }
    const Eigen::Vector3i at = first - voxelsIn(brick).min;
    Density* to =
        bricks_.contents(id) + size_t(at.x()) + kStrideY * size_t(at.y()) + kStrideZ * size_t(at.z());
    for (int i = 0; i < count; ++i)
        std::atomic_ref<Density>(to[i]).store(densities[i], std::memory_order_release);
}

void VoxelVolume::set(int i, int j, int k, Density density) {
    constexpr size_t kMostHolding = 8;
    if (bricks_.spareCount() < kMostHolding) bricks_.makeSpare(bricks_.ownCount() / 4 + kMostHolding);
    writeRow({i, j, k}, 1, &density);
}

Eigen::Vector3f VoxelVolume::gradient(int i, int j, int k) const noexcept {
    const size_t here = offset(i, j, k);
    constexpr size_t kStrides[3] = {1, kStrideY, kStrideZ};
    const int index[3] = {i, j, k};
    Eigen::Vector3f g;
    const Eigen::Vector3i& last = geometry_.dims;
    const bool is_within = (unsigned(i) < unsigned(last.x())) & (unsigned(j) < unsigned(last.y())) &
                           (unsigned(k) < unsigned(last.z()));
    if (is_within) {
        for (int axis = 0; axis < 3; ++axis)
            g[axis] = float(int(at(here + kStrides[axis])) - int(at(here - kStrides[axis]))) *
                      (inverse_spacing_[axis] / 2);
        return g;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const size_t low = index[axis] > -1 ? here - kStrides[axis] : here;
        const size_t high = index[axis] < geometry_.dims[axis] ? here + kStrides[axis] : here;
        const float steps = high - low == kStrides[axis] ? 1.0f : 2.0f;
        g[axis] = (float(at(high)) - float(at(low))) * inverse_spacing_[axis] / steps;
    }
    return g;
}

}  // namespace bonemill
