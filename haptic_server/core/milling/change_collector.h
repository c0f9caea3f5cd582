// Collects what a tick changes of the bone, leaf by leaf, within a budget of cells. What there is no time for
// waits: the next tick goes on from there to the last leaf, and then comes to the leaves before it.
//
// Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <cstddef>
#include <utility>

#include "haptic_server/core/milling/changed_runs.h"
#include "haptic_server/core/milling/milling_result.h"

namespace bonemill {

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
                 CollectLeaf&& collect_leaf, MillingResult& result) noexcept;

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

template <class IsWanted, class CollectLeaf>
void ChangeCollector::collect(const LeafLattice& lattice, const IndexBox& box, IsWanted&& is_wanted,
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

}  // namespace bonemill
