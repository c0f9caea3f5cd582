// Orders from other threads to the tick: give back the scanned bone, pause milling.
#pragma once

#include <atomic>
#include <vector>

#include "haptic_server/tick/bone_model.h"

namespace bonemill {

// Keeps a copy of the bone as it was and restores it a few leaves per tick, so that no tick becomes long.
class VolumeReset {
  public:
    // Copies the densities; allocates.
    explicit VolumeReset(const BoneModel& bone);

    // Any thread. Relaxed is enough: the tick only needs to see the flag at some later tick.
    void request() noexcept { is_requested_.store(true, std::memory_order_relaxed); }
    void pauseMilling(bool pause) noexcept { is_paused_.store(pause, std::memory_order_relaxed); }
    bool isMillingPaused() const noexcept { return is_paused_.load(std::memory_order_relaxed); }

    // Tick thread, RT-safe: takes up a request, from the first leaf on.
    void startIfRequested() noexcept;
    // Tick thread, RT-safe: leaves are still to be looked at.
    bool isRunning() const noexcept { return is_running_; }
    // Tick thread, RT-safe: looks at a bounded number of voxels, restores at most one changed leaf. False:
    // the point-shell pool was full.
    bool restoreSome(BoneModel& bone) noexcept;

  private:
    bool restoreLeaf(BoneModel& bone, LeafId leaf, bool& shell_is_complete) noexcept;

    bool readRows(const BoneModel& bone, const Eigen::Vector3i& first, int count) noexcept;

    VoxelVolume original_;
    std::vector<Density> now_, then_;  // rows of a leaf
    std::atomic<bool> is_requested_{false};
    std::atomic<bool> is_paused_{false};
    LeafId next_leaf_ = 0;
    bool is_running_ = false;
};

}  // namespace bonemill
