#include "haptic_server/tick/volume_reset.h"

#include <cstring>

namespace bonemill {
namespace {
constexpr int kVoxelsPerVersion = 4;  // a look at a leaf's version takes as long
constexpr int kVoxelsLookedAtPerTick =
    32'768;  // eight leaves of 16³, some 30 µs; at least one leaf, however large
}  // namespace

VolumeReset::VolumeReset(const BoneModel& bone)
    : original_(bone.volume.withoutSpareBricks()),
      now_(size_t(bone.lattice.leafCells().x()) + 1 + VoxelVolume::kReadSlack),
      then_(now_.size()) {}

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
        for (; next_leaf_ < bone.lattice.leafCount() && bone.lattice.version(next_leaf_) == 0 &&
               looked_at < kVoxelsLookedAtPerTick;
             ++next_leaf_)
            looked_at += kVoxelsPerVersion;
        is_running_ = next_leaf_ < bone.lattice.leafCount();
        if (!is_running_ || looked_at >= kVoxelsLookedAtPerTick ||
            restoreLeaf(bone, next_leaf_++, shell_is_complete))
            break;
        looked_at += voxels_per_leaf;
    }
    return shell_is_complete;
}

bool VolumeReset::restoreLeaf(BoneModel& bone, LeafId leaf, bool& shell_is_complete) noexcept {
    VoxelVolume& volume = bone.volume;
    const IndexBox cells = bone.lattice.cellsOf(leaf);
    const int count = cells.max.x() - cells.min.x() + 2;
    const IndexBox rows{cells.min, {cells.min.x(), cells.max.y() + 1, cells.max.z() + 1}};
    IndexBox changed;
    forEachIndex(rows, [&](const Eigen::Vector3i& first) {
        if (!readRows(bone, first, count)) return;
        for (int i = 0; i < count; ++i)
            if (now_[size_t(i)] != then_[size_t(i)]) changed.include(first + Eigen::Vector3i(i, 0, 0));
    });
    if (changed.isEmpty()) return false;
    bone.lattice.beginWrite(changed);
    forEachIndex({changed.min, {changed.min.x(), changed.max.y(), changed.max.z()}},
                 [&](const Eigen::Vector3i& first) {
                     const int width = changed.max.x() - changed.min.x() + 1;
                     if (readRows(bone, first, width)) volume.writeRow(first, width, then_.data());
                 });
    bone.lattice.endWrite(changed);
    bone.lattice.refreshRanges(volume, changed);
    shell_is_complete = bone.shell.refresh(volume, bone.lattice, {&changed, 1});
    return true;
}

// The row now and as it was; false if they are the same.
bool VolumeReset::readRows(const BoneModel& bone, const Eigen::Vector3i& first, int count) noexcept {
    bone.volume.readRow(first, count, now_.data());
    original_.readRow(first, count, then_.data());
    return std::memcmp(now_.data(), then_.data(), size_t(count) * sizeof(Density)) != 0;
}

}  // namespace bonemill
