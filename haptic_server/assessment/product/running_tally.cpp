#include "haptic_server/assessment/product/running_tally.h"

namespace bonemill {

RunningTally::RunningTally(const VoxelVolume& scanned, const VoxelVolume& now, const LeafLattice& lattice,
                           const JudgedTask& task)
    : scanned_(scanned),
      now_(now),
      lattice_(lattice),
      task_(task),
      seen_version_(lattice.leafCount()),
      removed_(task.zones.size() + 1) {}

bool RunningTally::update(uint32_t most_leaves) {
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

bool RunningTally::tryCount(LeafId leaf) {
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
void RunningTally::count(LeafId leaf, LeafCount& counted) const {
    const Density iso = scanned_.iso();
    const IndexBox voxels =
        lattice_.cellsOf(leaf).clamped(Eigen::Vector3i::Zero(), scanned_.dims().array() - 1);
    forEachIndex(voxels, [&](const Eigen::Vector3i& v) {
        if (now_.at(v.x(), v.y(), v.z()) >= iso || scanned_.at(v.x(), v.y(), v.z()) < iso) return;
        ++counted.removed[task_.map->at(v)];
        counted.ideal_removed += task_.isIdeal(v);
    });
}

}  // namespace bonemill
