#include "haptic_server/scans/densify/far_air.h"

#include <vector>

namespace bonemill {
namespace {

using Bricks = std::vector<uint8_t>;  // yes or no, by BrickId

Bricks bricksWithBone(const VoxelVolume& volume) {
    const BrickStore& bricks = volume.bricks();
    Bricks has_bone(bricks.brickCount());
    for (BrickId id = 0; id < bricks.brickCount(); ++id) {
        if (const auto shared = bricks.sharedDensity(id)) {
            has_bone[id] = *shared >= volume.iso();
            continue;
        }
        const Density* held = bricks.contents(id);
        has_bone[id] =
            std::any_of(held, held + kBrickSize, [&](Density density) { return density >= volume.iso(); });
    }
    return has_bone;
}

// Those that no other brick owns.
IndexBox voxelsOf(const VoxelVolume& volume, const Eigen::Vector3i& brick) {
    const Eigen::Vector3i first = brick.array() * kBrickCells - 1;
    return IndexBox{first, first.array() + (kBrickCells - 1)}.clamped(Eigen::Vector3i::Zero(),
                                                                      volume.dims().array() - 1);
}

// Clears them in every brick that holds them.
void clearVoxels(VoxelVolume& volume, const Eigen::Vector3i& brick) {
    if (volume.bricks().sharedDensity(volume.bricks().brickAt(brick.x(), brick.y(), brick.z())) == 0) return;
    const IndexBox owned = voxelsOf(volume, brick);
    if (owned.isEmpty()) return;
    const Density air[kBrickCells] = {};
    const IndexBox rows{owned.min, {owned.min.x(), owned.max.y(), owned.max.z()}};
    forEachIndex(rows, [&](const Eigen::Vector3i& row) {
        volume.writeRow(row, owned.max.x() - owned.min.x() + 1, air);
    });
}

}  // namespace

bool ownsAny(const VoxelVolume& volume, const Eigen::Vector3i& brick,
             const std::function<bool(size_t)>& is_kept) {
    if (!is_kept) return false;
    const Eigen::Vector3i& dims = volume.dims();
    bool owns = false;
    forEachIndex(voxelsOf(volume, brick), [&](const Eigen::Vector3i& v) {
        owns = owns ||
               is_kept(size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z())));
    });
    return owns;
}

void clearFarFromBone(VoxelVolume& volume, const std::function<bool(size_t)>& is_kept) {
    const Bricks has_bone = bricksWithBone(volume);
    forEachIndex(volume.bricks().allBricks(), [&](const Eigen::Vector3i& brick) {
        const bool is_near =
            anyBrickAround(volume.bricks(), brick, [&](BrickId near) { return has_bone[near] != 0; });
        if (!is_near && !ownsAny(volume, brick, is_kept)) clearVoxels(volume, brick);
    });
    volume.shareUniformBricks();
}

}  // namespace bonemill
