// This keeps copies of the bone as it was, and the way back to them, while the tick goes on: the tick gives
// back a few leaves at a time, so that none becomes long. This is also what pauses milling, and counts what
// the bone has lost.
//
// There are three kinds of callers. *Tick* is the tick thread, RT-safe. *Any* is any thread. *Keeper* is one
// normal thread at a time, the publisher's in a session; it allocates and is never RT-safe.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/bone/bone_snapshot.h"

namespace bonemill {

class BoneHistory {
  public:
    // Copies the densities of the scanned bone; allocates.
    explicit BoneHistory(const BoneModel& bone);

    // Any. Relaxed is enough: the tick only needs to see the flag at some later tick.
    void pauseMilling(bool pause) noexcept { is_paused_.store(pause, std::memory_order_relaxed); }
    bool isMillingPaused() const noexcept { return is_paused_.load(std::memory_order_relaxed); }
    // Any: counts the voxels at or above the iso-value, those of the scanned bone minus those of the
    // bone now.
    int64_t missingVoxels() const noexcept { return missing_voxels_.load(std::memory_order_relaxed); }

    // Any: this is the bone as it was at the start; it never changes.
    const VoxelVolume& scanned() const noexcept { return scanned_; }
    // Any: these are the densities that a snapshot stands for; `lattice` is that of its bone. It allocates,
    // so it is not RT-safe.
    VoxelVolume volumeOf(const BoneSnapshot& snapshot, const LeafLattice& lattice) const;

    // Keeper: takes the bone between two ticks, whole: what one tick mills is in it or not. It copies while
    // milling goes on, until a look at all leaves finds none changed; if none does for long, milling is held
    // (the force goes on) while the rest is copied. While the bone is being put back, this is the snapshot
    // to which it is.
    std::shared_ptr<const BoneSnapshot> snapshot(const BoneModel& bone);
    // Whoever runs no tick beside it, before the first: the bone, which is as scanned, becomes that of the
    // snapshot, as if it had been put back to it.
    void startFrom(BoneModel& bone, const std::shared_ptr<const BoneSnapshot>& snapshot);
    // Keeper: puts the bone back to this snapshot, or (null) to the scanned bone, instead of to what is on
    // its way, if anything is. Asked again for the one that is on its way, it goes on with that. Returns the
    // order's number, which grows with each: it is done once finishedOrder() is not below.
    uint64_t restore(std::shared_ptr<const BoneSnapshot> snapshot = nullptr);
    // Keeper: the number of the newest order to put the bone back; 0: none.
    uint64_t newestOrder() const noexcept { return orders_.back()->number; }
    // Keeper: the tick is not yet done with the last restore().
    bool isRestoring() const noexcept { return finishedOrder() != newestOrder(); }
    // Any: the number of the newest order to put the bone back that the tick is done with; 0: none.
    uint64_t finishedOrder() const noexcept { return finished_.load(std::memory_order_acquire); }

    // Tick: opens the part of the tick of this number that changes voxels. False means not now: a snapshot is
    // being taken, and there must be no endWrite().
    bool beginWrite(uint64_t tick) noexcept;
    // Tick: ends that part, and tells what milling changed meanwhile.
    void endWrite(uint32_t removed_voxels, uint32_t added_voxels) noexcept;
    // Tick, within a write: looks at a bounded number of voxels and restores at most one changed leaf. False
    // means that there is nothing to restore. Otherwise `shell_is_complete` says whether the point-shell pool
    // had room.
    bool restoreSome(BoneModel& bone, bool& shell_is_complete) noexcept;
    // Tick: the number of the newest order that it has begun; finishedOrder() follows.
    uint64_t takenUpOrder() const noexcept { return order_->number; }
    // Tick: what restoreSome() has last worked at is the way to the scanned bone.
    bool isTargetScanned() const noexcept { return !order_->target; }
    // Whoever runs no tick beside it: all of the last restore() that is still to do, at once.
    void restoreAll(BoneModel& bone) noexcept;

  private:
    // An order says where the tick is to go. Its number grows with each.
    struct Order {
        uint64_t number;
        std::shared_ptr<const BoneSnapshot> target;  // null: the scanned bone
    };
    class Hold;
    using Copies = std::vector<std::shared_ptr<const LeafCopy>>;  // by leaf; null: never written
    struct Moment {                                               // between two ticks
        uint64_t ticks;
        int64_t missing_voxels;
    };
    std::optional<Moment> moment() const noexcept;
    Moment copyWhole(const BoneModel& bone, Copies& copies);
    bool copyChanged(const BoneModel& bone, Copies& copies) const;
    std::shared_ptr<const LeafCopy> copyOf(const BoneModel& bone, LeafId leaf, uint32_t version) const;
    bool takeUpNewestOrder() noexcept;
    bool isInTarget(LeafId leaf) noexcept;
    void finishOrder() noexcept;
    bool restoreLeaf(BoneModel& bone, LeafId leaf, bool& shell_is_complete) noexcept;
    bool readRows(const BoneModel& bone, const IndexBox& cells, const Density* copy,
                  const Eigen::Vector3i& first, int count) noexcept;
    int64_t lostVoxels(int count, Density iso) const noexcept;

    VoxelVolume scanned_;

    // The keeper has these. The tick may look at three orders at most: the one it is known to have taken up,
    // one that it has taken up since, and the newest.
    std::deque<std::unique_ptr<const Order>> orders_;
    Copies last_copies_;  // of the newest snapshot, also of leaves that are as scanned again

    // The tick has these.
    const Order* order_;  // the newest taken up
    bool is_restoring_ = false;
    LeafId next_leaf_ = 0;
    size_t next_copy_ = 0;             // of the target's leaves, the first that is not behind next_leaf_
    uint64_t tick_ = 0;                // whose write is open
    std::vector<Density> now_, then_;  // rows of a leaf

    // The newest order until the tick takes it, then null: each side exchanges, so that the keeper knows
    // whether the tick has ever seen what it replaces. Release by the keeper, acquire by the tick: the order
    // is whole.
    std::atomic<const Order*> next_order_{nullptr};
    // Numbers of the order that the tick has taken up, and of the one it is done with: it looks at none
    // before the first. Release by the tick, acquire by the keeper: the tick has read the orders before, and
    // written what the finished one says.
    std::atomic<uint64_t> taken_up_{0}, finished_{0};
    // Each side sets its own and then looks at the other's, sequentially consistent: at least one of them
    // sees the other.
    std::atomic<bool> is_writing_{false}, is_held_{false};
    std::atomic<int64_t> missing_voxels_{0};  // written by the tick
    // Counts the ticks up to the last that wrote, it included. The tick stores it before is_writing_ goes.
    std::atomic<uint64_t> written_ticks_{0};
    std::atomic<bool> is_paused_{false};
};

}  // namespace bonemill
