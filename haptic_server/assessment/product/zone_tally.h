// Counts what is gone of each zone, of a whole bone and while it is milled.
//
// A voxel was bone if its scanned density is at or above the iso-value, and is gone if it is below now.
// Beside that, r = clip((before - now) / before, 0, 1) of what was bone tells how much of its density went.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/core/volume/leaf_lattice.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct ZoneCount {
    int64_t bone = 0;         // voxels that were bone
    int64_t removed = 0;      // of these, voxels that are gone
    double density_gone = 0;  // sum of r, voxels
};

struct ProductCounts {
    std::vector<ZoneCount> zones;  // by ZoneId: the first is what is in no zone
    int64_t ideal = 0;             // bone that shall be gone
    int64_t ideal_removed = 0;     // of that, what is gone
    IndexBox changed;              // around all that is gone or shall be

    int64_t removed() const noexcept;
};

// Neither volume may be written meanwhile. It takes one look at each voxel of both.
ProductCounts countProduct(const VoxelVolume& scanned, const VoxelVolume& now, const JudgedTask& task);

// Adds the figures "zone.*", those of each role ("target.*", ...), "outside.*" and "overlap.*".
void addZoneFigures(const ProductCounts& counts, const JudgedTask& task, double voxel_volume,
                    Figures& figures);

// Keeps the count of what is gone of each zone up with the bone while it is milled: looks only at leaves that
// changed. It gives what countProduct() does.
//
// It belongs to one normal thread beside the tick, which writes voxels between LeafLattice::beginWrite and
// endWrite; it takes no lock, and leaves that are being written wait for the next time. Not RT-safe: it
// allocates.
class RunningTally {
  public:
    // All must outlive this object. A leaf of version 0 was never written, and is as scanned; no other has
    // been looked at yet.
    RunningTally(const VoxelVolume& scanned, const VoxelVolume& now, const LeafLattice& lattice,
                 const JudgedTask& task)
        : scanned_(scanned),
          now_(now),
          lattice_(lattice),
          task_(task),
          seen_version_(lattice.leafCount()),
          removed_(task.zones.size() + 1) {}

    static constexpr uint32_t kLeavesAtOnce = 64;  // some milliseconds
    // Looks at up to N leaves that changed since; false: others still wait.
    bool update(uint32_t most_leaves = kLeavesAtOnce) {
        const LeafId leaves = lattice_.leafCount();
        bool is_all = true;
        uint32_t looked_at = 0;
        for (LeafId n = 0; n < leaves; ++n) {
            const LeafId leaf = (next_leaf_ + n) % leaves;
            if (lattice_.version(leaf) == seen_version_[leaf]) continue;
            if (looked_at++ == most_leaves) {
                next_leaf_ = leaf;
                return false;
            }
            is_all &= tryCount(leaf);
        }
        return is_all;
    }

    // Voxels that were bone and are gone, by ZoneId.
    const std::vector<int64_t>& removed() const noexcept { return removed_; }
    // The same of those that shall be gone.
    int64_t idealRemoved() const noexcept { return ideal_removed_; }

  private:
    struct LeafCount {
        std::vector<uint32_t> removed;  // by ZoneId
        uint32_t ideal_removed = 0;
    };
    bool tryCount(LeafId leaf) {
        const uint32_t version = lattice_.version(leaf);
        if (version & 1) return false;
        LeafCount counted;
        counted.removed.resize(removed_.size());
        count(leaf, counted);
        // The voxels were read with acquire, so this read cannot be older than they are.
        if (lattice_.version(leaf) != version) return false;
        seen_version_[leaf] = version;
        LeafCount& last = counted_[leaf];
        last.removed.resize(removed_.size());
        bool is_something = counted.ideal_removed > 0;
        for (size_t zone = 0; zone < removed_.size(); ++zone) {
            removed_[zone] += int64_t(counted.removed[zone]) - int64_t(last.removed[zone]);
            is_something |= counted.removed[zone] > 0;
        }
        ideal_removed_ += int64_t(counted.ideal_removed) - int64_t(last.ideal_removed);
        if (is_something)
            last = std::move(counted);
        else
            counted_.erase(leaf);
        return true;
    }
    // A leaf's voxels are those at the low corners of its cells.
    void count(LeafId leaf, LeafCount& counted) const {
        const Density iso = scanned_.iso();
        const IndexBox voxels =
            lattice_.cellsOf(leaf).clamped(Eigen::Vector3i::Zero(), scanned_.dims().array() - 1);
        forEachIndex(voxels, [&](const Eigen::Vector3i& v) {
            if (now_.at(v.x(), v.y(), v.z()) >= iso || scanned_.at(v.x(), v.y(), v.z()) < iso) return;
            ++counted.removed[task_.map->at(v)];
            counted.ideal_removed += task_.isIdeal(v);
        });
    }

    const VoxelVolume& scanned_;
    const VoxelVolume& now_;
    const LeafLattice& lattice_;
    const JudgedTask& task_;
    std::vector<uint32_t> seen_version_;
    std::unordered_map<LeafId, LeafCount> counted_;  // those with something gone
    std::vector<int64_t> removed_;
    int64_t ideal_removed_ = 0;
    LeafId next_leaf_ = 0;  // where the next update starts, so that busy leaves do not starve the others
};

}  // namespace bonemill
