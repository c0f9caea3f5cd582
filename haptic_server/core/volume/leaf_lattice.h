// The octree over the volume is a lattice of leaves, min/max densities above them, and a version per leaf.
//
// Cell (i, j, k) is the cube between voxels (i, j, k) and (i+1, j+1, k+1), for indices -1 .. dims-1. Each
// leaf owns leaf_cells cells per axis (fewer at the far border); a leaf's voxels are the corners of its
// cells. A node of level l covers 2^l leaves per axis; level 0 are the leaves, the top level is the root.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

using LeafId = uint32_t;  // x fastest over the lattice; the node id on the wire

struct DensityRange {
    Density min = kMaxDensity;
    Density max = 0;

    // Does the surface of this iso-value lie between its ends?
    bool holds(Density iso) const noexcept { return min < iso && max >= iso; }
    bool operator==(const DensityRange&) const = default;
};

class LeafLattice {
  public:
    // A leaf has leaf_cells cells per axis, each >= 1. Reads the volume once; allocates.
    LeafLattice(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells);

    // The thesis' way gives 2^depth leaves per axis.
    static Eigen::Vector3i leafCellsOfDepth(const VolumeGeometry& geometry, int depth);

    const Eigen::Vector3i& leafCells() const noexcept { return leaf_cells_; }
    const Eigen::Vector3i& leavesPerAxis() const noexcept { return levels_[0].nodes; }
    uint32_t leafCount() const noexcept { return uint32_t(levels_[0].range.size()); }
    int levelCount() const noexcept { return int(levels_.size()); }

    LeafId leafId(const Eigen::Vector3i& leaf) const noexcept {
        const auto& n = levels_[0].nodes;
        BONEMILL_ASSERT((leaf.array() >= 0).all() && (leaf.array() < n.array()).all());
        return LeafId(placeIn(n, leaf));
    }
    Eigen::Vector3i leafIndex(LeafId id) const noexcept {
        const auto& n = levels_[0].nodes;
        return {int(id) % n.x(), int(id) / n.x() % n.y(), int(id) / (n.x() * n.y())};
    }
    // Cells of a leaf, both ends included.
    IndexBox cellsOf(LeafId id) const noexcept;
    // Leaves that own any of these cells (clamped to the lattice), both ends included.
    IndexBox leavesOfCells(const IndexBox& cells) const noexcept;

    // RT-safe, tick thread only: the voxels in this box may have changed since the ranges were last right,
    // and no others but in boxes for which this is called as well. Makes the ranges of the leaves they belong
    // to those of a full scan, renews up to the root. direction -1: no density rose since then, +1: none
    // fell; that is quicker.
    void refreshRanges(const VoxelVolume& volume, const IndexBox& changed_voxels, int direction = 0) noexcept;

    // Leaves whose mesh or point-shell can change when these voxels do: those within kInfluence of
    // their cells.
    IndexBox leavesOfWrite(const IndexBox& changed_voxels) const noexcept {
        return leavesOfCells(
            {changed_voxels.min.array() - kInfluence, changed_voxels.max.array() + (kInfluence - 1)});
    }
    static constexpr int kInfluence = 2;  // a cell's corners reach 1 voxel, their gradients one more

    // RT-safe, tick thread only: around a write to these voxels. The versions of leavesOfWrite() are odd
    // while being written, even after.
    void beginWrite(const IndexBox& changed_voxels) noexcept;
    void endWrite(const IndexBox& changed_voxels) noexcept;

    // Tick thread only: so many writes were begun.
    uint64_t writeCount() const noexcept { return write_count_; }

    // It is for any thread. acquire: pairs with endWrite's release, so voxels read after it are at
    // least that new.
    uint32_t version(LeafId id) const noexcept { return versions_[id].load(std::memory_order_acquire); }

    // It is for the tick thread only (the mesher computes its own from the voxels). Does the density range
    // hold the iso-value?
    bool mayHoldSurface(LeafId id, Density iso) const noexcept { return levels_[0].range[id].holds(iso); }

    // It searches from the top down, RT-safe, for the tick thread only: calls visit(LeafId) for every leaf
    // that owns any of these cells, unless is_wanted(const DensityRange&, const IndexBox& cells) is false for
    // it or a node above it. Leaves come in ascending order of the lattice within each node.
    template <class IsWanted, class Visit>
    void forEachLeaf(const IndexBox& cells, IsWanted&& is_wanted, Visit&& visit) const noexcept {
        const IndexBox leaves = leavesOfCells(cells);
        if (!cells.isEmpty() && !leaves.isEmpty())
            descend(levelCount() - 1, Eigen::Vector3i::Zero(), leaves, is_wanted, visit);
    }

    // It does the same for every leaf whose cells meet `box` (V, m) and whose range holds iso.
    template <class Visit>
    void forEachSurfaceLeaf(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& spacing, Density iso,
                            Visit&& visit) const noexcept {
        // Clamp before the conversion to int: the box may lie anywhere.
        const Eigen::Array3d low =
            (box.min().array() / spacing.array()).max(-1.0).min(dims_.cast<double>().array());
        const Eigen::Array3d high =
            (box.max().array() / spacing.array()).max(-2.0).min(dims_.cast<double>().array() - 1);
        const IndexBox cells{low.floor().cast<int>().matrix(), high.floor().cast<int>().matrix()};
        forEachLeaf(
            cells, [iso](const DensityRange& range, const IndexBox&) { return range.holds(iso); }, visit);
    }

    uint32_t nodeCount(int level) const noexcept { return uint32_t(levels_[size_t(level)].range.size()); }
    const DensityRange& range(int level, uint32_t node) const noexcept { return levels_[level].range[node]; }

  private:
    struct Level {
        Eigen::Vector3i nodes;
        std::vector<DensityRange> range;
    };
    IndexBox voxelsOf(LeafId id) const noexcept {
        const IndexBox cells = cellsOf(id);
        return {cells.min, cells.max.array() + 1};
    }
    void refreshParents(const IndexBox& leaves) noexcept;
    template <class IsWanted, class Visit>
    void descend(int level, const Eigen::Vector3i& node, const IndexBox& leaves, IsWanted& is_wanted,
                 Visit& visit) const noexcept;

    Eigen::Vector3i leaf_cells_;
    Eigen::Vector3i dims_;
    std::vector<Level> levels_;
    std::vector<std::atomic<uint32_t>> versions_;
    uint64_t write_count_ = 0;
};

template <class IsWanted, class Visit>
void LeafLattice::descend(int level, const Eigen::Vector3i& node, const IndexBox& leaves, IsWanted& is_wanted,
                          Visit& visit) const noexcept {
    const Eigen::Vector3i first = node * (1 << level);
    const Eigen::Vector3i last = first.array() + ((1 << level) - 1);
    if ((first.array() > leaves.max.array()).any() || (last.array() < leaves.min.array()).any()) return;
    const DensityRange& range = levels_[level].range[placeIn(levels_[level].nodes, node)];
    const IndexBox cells{first.cwiseProduct(leaf_cells_).array() - 1,
                         (last.array() + 1).matrix().cwiseProduct(leaf_cells_).array() - 2};
    if (!is_wanted(range, cells)) return;
    if (level == 0) return visit(leafId(node));
    const auto& below = levels_[level - 1].nodes;
    for (int octant = 0; octant < 8; ++octant) {
        const Eigen::Vector3i child =
            2 * node + Eigen::Vector3i(octant & 1, octant >> 1 & 1, octant >> 2 & 1);
        if ((child.array() < below.array()).all()) descend(level - 1, child, leaves, is_wanted, visit);
    }
}

}  // namespace bonemill
