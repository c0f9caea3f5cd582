#include "haptic_server/core/milling/change_collector.h"

#include <algorithm>

namespace bonemill {

ChangedRuns::ChangedRuns(const LeafLattice& lattice, const Eigen::Vector3i& most_voxels) {
    const Eigen::Array3d most = most_voxels.cast<double>();
    const Eigen::Array3d leaf_cells = lattice.leafCells().cast<double>();
    const Eigen::Array3d parts = (most / kBrickCells).floor() + (most / leaf_cells).floor() + 3;
    densities_.resize(size_t(most.prod()));
    runs_.resize(size_t(parts.x() * most.y() * most.z()));
    changed_.resize(size_t(parts.prod()));
    end_run_.resize(changed_.size());
}

void ChangedRuns::add(const Eigen::Vector3i& first, int count, const Density* old, const Density* fresh,
                      IndexBox& changed) noexcept {
    int low = 0, high = count - 1;
    while (old[low] == fresh[low]) ++low;
    while (old[high] == fresh[high]) --high;
    std::copy(fresh + low, fresh + high + 1, densities_.begin() + ptrdiff_t(density_count_));
    runs_[run_count_++] = {first + Eigen::Vector3i(low, 0, 0), density_count_, high - low + 1};
    density_count_ += size_t(high - low) + 1;
    changed.include(first + Eigen::Vector3i(low, 0, 0));
    changed.include(first + Eigen::Vector3i(high, 0, 0));
}

void ChangedRuns::closeLeaf(const IndexBox& changed) noexcept {
    changed_[leaf_count_] = changed;
    end_run_[leaf_count_++] = run_count_;
}

bool ChangedRuns::write(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell,
                        int direction) noexcept {
    size_t run = 0;
    for (size_t n = 0; n < leaf_count_; ++n) {
        lattice.beginWrite(changed_[n]);
        for (; run < end_run_[n]; ++run)
            volume.writeRow(runs_[run].first, runs_[run].count, &densities_[runs_[run].first_density]);
        lattice.endWrite(changed_[n]);
    }
    for (size_t n = 0; n < leaf_count_; ++n) lattice.refreshRanges(volume, changed_[n], direction);
    return shell.refresh(volume, lattice, {changed_.data(), leaf_count_});
}

bool ChangeCollector::takePart(VoxelVolume& volume, size_t looked_at, const MillingResult& of_part,
                               MillingResult& of_leaf) noexcept {
    const size_t cells_before = std::exchange(cells_, cells_ + looked_at + size_t(of_part.changed.count()));
    if (cells_ > most_cells_ && cells_before > 0) {
        changes_.backTo(part_begin_);
        return false;
    }
    if (of_part.changed.isEmpty()) return true;
    if (!volume.openBricksIn(of_part.changed)) {
        changes_.backTo(part_begin_);
        of_leaf.has_room = false;
        return true;
    }
    of_leaf.include(of_part);
    return true;
}

}  // namespace bonemill
