// These are the voxels that one tick changes: they are collected leaf by leaf in runs along x, then written
// with all that hangs on them (leaf versions, density ranges, point-shell). Construction allocates; all else
// is RT-safe, for the tick thread only.
#pragma once

#include <cstddef>
#include <vector>

#include "haptic_server/core/contact/point_shell.h"

namespace bonemill {

class ChangedRuns {
  public:
    // There is room for changes in any box of N voxels, cut at the borders of leaves and of bricks.
    ChangedRuns(const LeafLattice& lattice, const Eigen::Vector3i& most_voxels);

    void clear() noexcept { run_count_ = density_count_ = leaf_count_ = 0; }
    bool isEmpty() const noexcept { return leaf_count_ == 0; }

    // Adds a row of `count` voxels from `first` on, from the first to the last one that differs (one does).
    // Widens `changed` by them.
    void add(const Eigen::Vector3i& first, int count, const Density* old, const Density* fresh,
             IndexBox& changed) noexcept;
    // What was added since the last call is all that changes in one leaf, in this box.
    void closeLeaf(const IndexBox& changed) noexcept;

    // A mark is the way to take back what was added since.
    struct Mark {
        size_t runs, densities;
    };
    Mark mark() const noexcept { return {run_count_, density_count_}; }
    void backTo(const Mark& mark) noexcept { run_count_ = mark.runs, density_count_ = mark.densities; }

    // With direction -1 no density rises, with +1 none falls. The bricks must be open
    // (VoxelVolume::openBricksIn). False means that the shell's pool is full and some leaves kept their
    // old points.
    bool write(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell, int direction) noexcept;

  private:
    struct Run {
        Eigen::Vector3i first;
        size_t first_density;
        int count;
    };
    std::vector<Run> runs_;  // the first run_count_
    size_t run_count_ = 0;
    std::vector<Density> densities_;  // the first density_count_
    size_t density_count_ = 0;
    std::vector<IndexBox> changed_;  // leaf by leaf; the first leaf_count_
    std::vector<size_t> end_run_;    // of each: its runs go from the last one's to here
    size_t leaf_count_ = 0;
};

}  // namespace bonemill
