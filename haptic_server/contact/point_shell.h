// The bone's contact points: one per s×s×s cells crossed by the iso-surface (thesis §4.2.3, scaling factor
// s).
//
// The thesis leaves two choices open; ours: the point is the mean of the iso-crossings on all grid edges of
// the s×s×s block (linear interpolation along each edge), its normal the gradient interpolated trilinearly
// from the block's eight corners, pointing out of the bone. Blocks start at each leaf's first cell and are
// cut at its border.
//
// Points live in fixed blocks of a pool sized at construction, in ascending order of their cells inside each
// leaf, so that an incremental refresh gives the very bits of a full rebuild. Only the tick thread touches a
// PointShell.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/volume/leaf_lattice.h"

namespace bonemill {

struct ShellPoint {
    Eigen::Vector3f position;  // V, m
    Eigen::Vector3f normal;    // V, unit, out of the bone; zero where the density has no gradient
    uint32_t key;              // block coordinates inside the leaf, 10 bits each, z most significant
};

// Structure of arrays for the contact loop.
struct ShellBlock {
    static constexpr uint32_t kCapacity = 64;
    float x[kCapacity], y[kCapacity], z[kCapacity];
    float nx[kCapacity], ny[kCapacity], nz[kCapacity];
    uint32_t key[kCapacity];
    uint32_t next;
};

class PointShell {
  public:
    // Builds every leaf. `spare_points` is room for surface that milling will open. Allocates.
    // Throws std::invalid_argument for leaves of more than 1024 blocks per axis.
    PointShell(const VoxelVolume& volume, const LeafLattice& lattice, int scaling_factor,
               size_t spare_points = kDefaultSparePoints);

    // Rebuilds the points that the voxels in `changed_voxels` can influence. RT-safe. False: the pool is full
    // and some leaves kept their old points.
    bool refresh(const VoxelVolume& volume, const LeafLattice& lattice,
                 const IndexBox& changed_voxels) noexcept;

    // Calls visit(const ShellBlock&, uint32_t count) for the leaf's points in order. RT-safe.
    template <class Visit>
    void forEachBlock(LeafId leaf, Visit&& visit) const noexcept {
        uint32_t left = leaves_[leaf].count;
        for (uint32_t block = leaves_[leaf].first; left > 0; block = blocks_[block].next) {
            const uint32_t count = left < ShellBlock::kCapacity ? left : ShellBlock::kCapacity;
            visit(blocks_[block], count);
            left -= count;
        }
    }

    uint32_t pointCount(LeafId leaf) const noexcept { return leaves_[leaf].count; }
    size_t pointCount() const noexcept { return point_count_; }
    int scalingFactor() const noexcept { return scaling_factor_; }

    static constexpr size_t kDefaultSparePoints = 400'000;  // about 50 cm² of new surface at 0.125 mm

  private:
    struct Leaf {
        uint32_t first = kNoBlock;
        uint32_t count = 0;
    };
    static constexpr uint32_t kNoBlock = ~0u;

    void collectNew(const VoxelVolume& volume, const IndexBox& leaf_cells, const IndexBox& blocks) noexcept;
    void mergeWithOld(LeafId leaf, const IndexBox& blocks) noexcept;
    bool store(LeafId leaf) noexcept;
    uint32_t takeBlock() noexcept;

    int scaling_factor_;
    std::vector<Leaf> leaves_;
    std::vector<ShellBlock> blocks_;
    uint32_t free_blocks_ = kNoBlock;
    uint32_t free_count_ = 0;
    size_t point_count_ = 0;
    std::vector<ShellPoint> fresh_;   // scratch: the rebuilt points of one leaf
    std::vector<ShellPoint> merged_;  // scratch: all points of one leaf
    size_t fresh_size_ = 0;
    size_t merged_size_ = 0;
    std::vector<uint8_t> row_;  // scratch: states of one row of voxel columns
};

}  // namespace bonemill
