#include "haptic_server/tick/volume_reset.h"

namespace bonemill {
namespace {
constexpr LeafId kLeavesLookedAtPerTick = 32;  // comparing 32 unchanged leaves of 16³ takes about as long as milling
}  // namespace

VolumeReset::VolumeReset(const BoneModel& bone) {
    const Eigen::Vector3i& dims = bone.volume.dims();
    original_.resize(bone.volume.offset(dims.x(), dims.y(), dims.z()) + 1);
    for (size_t i = 0; i < original_.size(); ++i) original_[i] = bone.volume.at(i);
}

bool VolumeReset::isRunning() noexcept {
    if (is_requested_.exchange(false, std::memory_order_relaxed)) {
        is_running_ = true;
        next_leaf_ = 0;
    }
    return is_running_;
}

bool VolumeReset::restoreSome(BoneModel& bone) noexcept {
    bool shell_is_complete = true;
    for (LeafId n = 0; n < kLeavesLookedAtPerTick; ++n) {
        if (next_leaf_ == bone.lattice.leafCount()) {
            is_running_ = false;
            return true;
        }
        const LeafId leaf = next_leaf_++;
        // A version of 0 means that nothing near the leaf was ever written.
        if (bone.lattice.version(leaf) != 0 && restoreLeaf(bone, leaf, shell_is_complete)) break;
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
    for_each_difference([&](const Eigen::Vector3i&, size_t offset) { volume.set(offset, original_[offset]); });
    bone.lattice.endWrite(changed);
    bone.lattice.refreshRanges(volume, changed);
    shell_is_complete = bone.shell.refresh(volume, bone.lattice, changed);
    return true;
}

}  // namespace bonemill
