// Collects what a tick changes of the bone, leaf by leaf, within a budget of cells. What there is no time for
// waits: the next tick goes on from there to the last leaf, and then comes to the leaves before it.
//
// Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/milling/milling_result.h"

namespace bonemill {

// These are the voxels that one tick changes: they are collected leaf by leaf in runs along x, then written
// with all that hangs on them (leaf versions, density ranges, point-shell). Construction allocates; all else
// is RT-safe, for the tick thread only.
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

class ChangeCollector {
  public:
    static constexpr int kAllParts = -1;

    // There is room for changes in any box of N voxels. A tick makes the surface of at most
    // `most_cells` anew, but for the first part that it changes, however large that is.
    ChangeCollector(const LeafLattice& lattice, const Eigen::Vector3i& most_voxels, size_t most_cells)
        : changes_(lattice, most_voxels), most_cells_(most_cells) {}

    // Starts a tick's changes. For each leaf that owns voxels of `box`, in turn, as
    // LeafLattice::forEachLeaf() with is_wanted: collect_leaf(const IndexBox& voxels, int first_part,
    // MillingResult& of_leaf) adds what changes among these voxels, from one of the leaf's parts on; it
    // returns the part for which there was no time, or kAllParts.
    template <class IsWanted, class CollectLeaf>
    void collect(const LeafLattice& lattice, const IndexBox& box, IsWanted&& is_wanted,
                 CollectLeaf&& collect_leaf, MillingResult& result) noexcept {
        changes_.clear();
        cells_ = 0;
        const LeafId first = std::exchange(next_leaf_, kNoLeaf);
        const int first_part = next_part_;
        for (const bool is_second_round : {false, true}) {
            if (is_second_round && first == kNoLeaf) break;
            bool is_later = first == kNoLeaf;
            // A voxel is the first corner of its cell.
            lattice.forEachLeaf(box, is_wanted, [&](LeafId leaf) {
                is_later |= leaf == first;
                if (is_later == is_second_round || next_leaf_ != kNoLeaf) return;
                MillingResult of_leaf;
                next_part_ = collect_leaf(lattice.cellsOf(leaf).clamped(box.min, box.max),
                                          leaf == first ? first_part : 0, of_leaf);
                if (!of_leaf.changed.isEmpty()) changes_.closeLeaf(of_leaf.changed);
                result.include(of_leaf);
                if (next_part_ == kAllParts) return;
                next_leaf_ = leaf;
                result.is_cut_short = true;
            });
        }
    }

    // The parts of a leaf are those of its bricks. Calls collect_part(part, offset) for each, from first_part
    // on; returns the first for which that is false, or kAllParts.
    template <class CollectPart>
    static int collectBricks(const VoxelVolume& volume, const IndexBox& voxels, int first_part,
                             CollectPart&& collect_part) noexcept {
        int n = 0, left = kAllParts;
        volume.forEachOwnedPart(voxels, [&](const IndexBox& part, size_t offset) {
            const int index = n++;
            if (index >= first_part && left == kAllParts && !collect_part(part, offset)) left = index;
        });
        return left;
    }
    // The rows of one part are collected by beginPart(), ChangedRuns::add() for each row that changes,
    // and takePart().
    ChangedRuns& beginPart() noexcept {
        part_begin_ = changes_.mark();
        return changes_;
    }
    // Keeps the part's rows, which change what `of_part` says; looking for them counts as `looked_at` cells.
    // False says that this is more than a tick's cells, and nothing of the part is kept; nor is anything
    // without memory for its bricks.
    bool takePart(VoxelVolume& volume, size_t looked_at, const MillingResult& of_part,
                  MillingResult& of_leaf) noexcept;

    bool isEmpty() const noexcept { return changes_.isEmpty(); }
    // This does what ChangedRuns::write() does.
    bool write(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell, int direction) noexcept {
        return changes_.write(volume, lattice, shell, direction);
    }

    // From now on it is at most so many.
    void limit(size_t most_cells) noexcept { most_cells_ = most_cells; }

    // Gives up what waits.
    void forgetTurn() noexcept { next_leaf_ = kNoLeaf; }

  private:
    static constexpr LeafId kNoLeaf = ~LeafId(0);

    ChangedRuns changes_;
    ChangedRuns::Mark part_begin_{};
    size_t most_cells_;
    size_t cells_ = 0;            // of this tick
    LeafId next_leaf_ = kNoLeaf;  // where the last tick was cut short
    int next_part_ = 0;
};

}  // namespace bonemill
