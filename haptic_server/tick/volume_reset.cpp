#include "haptic_server/tick/volume_reset.h"

namespace bonemill {
namespace {
constexpr int kVoxelsLookedAtPerTick =
    32'768;  // eight leaves of 16³, some 30 µs; at least one leaf, however large
}  // namespace

VolumeReset::VolumeReset(const BoneModel& bone) {
    const Eigen::Vector3i& dims = bone.volume.dims();
    original_.resize(bone.volume.offset(dims.x(), dims.y(), dims.z()) + 1);
    for (size_t i = 0; i < original_.size(); ++i) original_[i] = bone.volume.at(i);
}

void VolumeReset::startIfRequested() noexcept {
    if (!is_requested_.exchange(false, std::memory_order_relaxed)) return;
    is_running_ = true;
    next_leaf_ = 0;
}

bool VolumeReset::restoreSome(BoneModel& bone) noexcept {
    const int voxels_per_leaf = bone.lattice.leafCells().prod();
    bool shell_is_complete = true;
    for (int looked_at = 0; looked_at < kVoxelsLookedAtPerTick;) {
        // A version of 0 means that nothing near the leaf was ever written.
        while (next_leaf_ < bone.lattice.leafCount() && bone.lattice.version(next_leaf_) == 0) ++next_leaf_;
        is_running_ = next_leaf_ < bone.lattice.leafCount();
        if (!is_running_ || restoreLeaf(bone, next_leaf_++, shell_is_complete)) break;
        looked_at += voxels_per_leaf;
    }
    return shell_is_complete;
}

bool VolumeReset::restoreLeaf(BoneModel& bone, LeafId leaf, bool& shell_is_complete) noexcept {
    VoxelVolume& volume = bone.volume;
    const IndexBox cells = bone.lattice.cellsOf(leaf);
    IndexBox changed;
    const auto for_each_difference = [&](auto&& act) {
        for (int k = cells.min.z(); k <= cells.max.z() + 1; ++k)
            for (int j = cells.min.y(); j <= cells.max.y() + 1; ++j)
                for (int i = cells.min.x(); i <= cells.max.x() + 1; ++i) {
                    const size_t offset = volume.offset(i, j, k);
                    if (volume.at(offset) != original_[offset]) act(Eigen::Vector3i(i, j, k), offset);
                }
    };
    for_each_difference([&](const Eigen::Vector3i& voxel, size_t) { changed.include(voxel); });
    if (changed.isEmpty()) return false;
    bone.lattice.beginWrite(changed);
    for_each_difference(
        [&](const Eigen::Vector3i&, size_t offset) { volume.set(offset, original_[offset]); });
    bone.lattice.endWrite(changed);
    bone.lattice.refreshRanges(volume, changed);
    shell_is_complete = bone.shell.refresh(volume, bone.lattice, changed);
    return true;
}

}  // namespace bonemill
