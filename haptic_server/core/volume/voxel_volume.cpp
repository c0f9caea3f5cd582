#include "haptic_server/core/volume/voxel_volume.h"

#include <cstring>

namespace bonemill {

VoxelVolume::VoxelVolume(const VolumeGeometry& geometry, Density iso)
    : VoxelVolume(geometry, iso, BrickStore(geometry.dims.array() + 2)) {}

VoxelVolume::VoxelVolume(const VolumeGeometry& geometry, Density iso, BrickStore bricks)
    : geometry_(geometry),
      iso_(iso),
      inverse_spacing_(geometry.spacing.cwiseInverse().cast<float>()),
      bricks_(std::move(bricks)) {}

bool VoxelVolume::isBoneAt(const Eigen::Vector3d& p_V) const noexcept {
    const Eigen::Array3d place = (p_V.array() / spacing().array()).round();
    const bool is_inside = (place >= 0).all() && (place < dims().cast<double>().array()).all();
    if (!is_inside) return false;
    const Eigen::Vector3i voxel = place.cast<int>();
    return at(voxel.x(), voxel.y(), voxel.z()) >= iso_;
}

void VoxelVolume::readRow(const Eigen::Vector3i& first, int count, Density* out) const noexcept {
    forEachRun(first, count, [&](size_t offset, int n) {
        // Always as many as a brick can have: a copy of known size is a few moves.
        std::memcpy(out, ownerData() + offset, kMaxInBrick * sizeof(Density));
        out += n;
    });
}

std::optional<Density> VoxelVolume::uniformDensity(const Eigen::Vector3i& cell) const noexcept {
    return bricks_.sharedDensity(bricks_.brickOf(cell.x() + 1, cell.y() + 1, cell.z() + 1));
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

bool VoxelVolume::openBricksIn(const IndexBox& voxels) noexcept {
    bool has_room = true;
    forEachIndex(bricksHolding(voxels), [&](const Eigen::Vector3i& b) {
        const BrickId brick = bricks_.brickAt(b.x(), b.y(), b.z());
        if (!bricks_.sharedDensity(brick)) return;
        if (bricks_.spareCount() > 0)
            bricks_.open(brick);
        else
            has_room = false;
    });
    return has_room;
}

void VoxelVolume::writeRow(const Eigen::Vector3i& first, int count, const Density* densities) noexcept {
    const IndexBox bricks = bricksHolding({first, {first.x() + count - 1, first.y(), first.z()}});
    const auto place = [](int index, int brick) { return index + 1 - brick * kBrickCells + kBrickLow; };
    for (int z = bricks.min.z(); z <= bricks.max.z(); ++z)
        for (int y = bricks.min.y(); y <= bricks.max.y(); ++y) {
            const size_t row =
                kStrideY * size_t(place(first.y(), y)) + kStrideZ * size_t(place(first.z(), z));
            BrickId brick = bricks_.brickAt(bricks.min.x(), y, z);
            for (int x = bricks.min.x(); x <= bricks.max.x(); ++x, ++brick) {
                const int at = place(first.x(), x);  // of the first one, in this brick or before it
                const int low = std::max(0, -at), high = std::min(count, kBrickEdge - at);
                if (!hasOwn(brick, densities + low, high - low)) continue;
                Density* to = bricks_.contents(brick) + row + size_t(at + low);
                for (int i = 0; i < high - low; ++i)
                    std::atomic_ref<Density>(to[i]).store(densities[low + i], std::memory_order_release);
            }
        }
}

// Opens the brick unless it holds these densities as it is; false then, and without a spare one.
bool VoxelVolume::hasOwn(BrickId brick, const Density* densities, int count) noexcept {
    const auto shared = bricks_.sharedDensity(brick);
    if (!shared) return true;
    if (std::all_of(densities, densities + count, [=](Density d) { return d == *shared; })) return false;
    if (bricks_.spareCount() == 0) return false;
    bricks_.open(brick);
    return true;
}

void VoxelVolume::set(int i, int j, int k, Density density) {
    constexpr size_t kMaxHolding = 8;
    if (bricks_.spareCount() < kMaxHolding) bricks_.makeSpare(bricks_.ownCount() / 4 + kMaxHolding);
    writeRow({i, j, k}, 1, &density);
}

// Central differences (thesis eq 1-3 over twice the distance), one-sided at the border of air.
Eigen::Vector3f VoxelVolume::gradient(int i, int j, int k) const noexcept {
    constexpr ptrdiff_t kStrides[3] = {1, kStrideY, kStrideZ};
    const size_t here = offset(i, j, k);
    const auto neighbour = [&](int axis, int step) {
        return at(size_t(ptrdiff_t(here) + step * kStrides[axis]));
    };
    const Eigen::Vector3i voxel(i, j, k);
    const bool is_inside = (voxel.array() >= 0).all() && (voxel.array() < dims().array()).all();
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        if (is_inside) {
            gradient[axis] =
                float(int(neighbour(axis, 1)) - int(neighbour(axis, -1))) * (inverse_spacing_[axis] / 2);
            continue;
        }
        const int low = voxel[axis] > -1 ? -1 : 0, high = voxel[axis] < dims()[axis] ? 1 : 0;
        gradient[axis] = (float(neighbour(axis, high)) - float(neighbour(axis, low))) *
                         inverse_spacing_[axis] / float(high - low);
    }
    return gradient;
}

}  // namespace bonemill
