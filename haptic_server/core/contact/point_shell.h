// The bone has contact points at one or several levels of detail: one per s×s×s cells crossed by the
// iso-surface (thesis §4.2.3, scaling factor s), for each level's s.
//
// The thesis leaves open where a point lies and what it stands for; ours: the surface in a block of cells is
// its marching-cubes triangles; their area is the point's area, their area centroid, moved onto the trilinear
// iso-surface, the point (shell_point.h). So at every level the areas add up to that of the drawn surface.
// Blocks without area (surface that only touches a voxel) give no point. Blocks start at each leaf's first
// cell and are cut at its border.
//
// A point is off the true surface of curvature radius R by the tolerance of shell_point.h, and by the
// trilinear field's own error, below h²/(4 R) for voxels h that sample a smooth density.
//
// Points live in fixed blocks of a pool sized at construction, in ascending order of their cells inside
// each leaf, so that an incremental refresh gives the very bits of a full rebuild. Only the tick thread
// touches a PointShell.
//
// Only the level that is followed, and one that is being prepared to be followed next, are kept up to date;
// in the others the leaves that changed are stale: they hold old points until prepare() rebuilds them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/contact/fresh_points.h"
#include "haptic_server/core/contact/shell_pool.h"
#include "haptic_server/core/contact/surface_cells.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

struct ShellLevel {
    int factor = 1;  // s, cells per block edge
    ShellNormals normals = ShellNormals::kCentralDifference;
};

struct ShellConfig {
    static constexpr size_t kDefaultSparePoints = 400'000;  // about 50 cm² of new surface at 0.125 mm

    std::vector<ShellLevel> levels{ShellLevel{}};  // of distinct factors >= 1
    // There is room for surface that milling will open, in points of one cell each; coarser levels get as
    // much surface.
    size_t spare_points = kDefaultSparePoints;
};

class PointShell {
  public:
    // Builds every leaf at every level and follows level 0. It allocates. Throws std::invalid_argument for
    // factors that are not distinct and >= 1 and for leaves of more than 1024 blocks per axis.
    PointShell(const VoxelVolume& volume, const LeafLattice& lattice, const ShellConfig& config);

    // Rebuilds the points that the voxels in these boxes can influence, but for stale leaves. It is RT-safe.
    // False says that the pool is full and some leaves kept their old points.
    bool refresh(const VoxelVolume& volume, const LeafLattice& lattice,
                 std::span<const IndexBox> changed_voxels) noexcept;

    // From now on this level is kept up to date, and no other one. Its stale leaves stay stale: prepare() it
    // first. It is RT-safe.
    void follow(int level) noexcept {
        followed_ = level;
        prepared_ = kNone;
    }
    int followed() const noexcept { return followed_; }

    struct Preparation {
        bool is_ready;     // no leaf of the level is stale any more
        bool is_complete;  // false: the pool is full and some leaves kept their old points
    };
    // Rebuilds at most `most_leaves` stale leaves of this level, beside the one that is followed. The level's
    // other leaves are kept up to date as long as no other level is prepared or followed, so that preparing
    // comes to an end. It is RT-safe.
    Preparation prepare(const VoxelVolume& volume, const LeafLattice& lattice, int level,
                        int most_leaves) noexcept;
    size_t staleLeaves(int level) const noexcept { return levels_[size_t(level)].stale_count; }

    int levelCount() const noexcept { return int(levels_.size()); }
    int scalingFactor(int level) const noexcept { return levels_[size_t(level)].config.factor; }
    // Returns the level of this factor, -1 if there is none.
    int levelOf(int factor) const noexcept;

    // Calls visit(const ShellBlock&, uint32_t count) for the leaf's points in order. It is RT-safe.
    template <class Visit>
    void forEachBlock(int level, LeafId leaf, Visit&& visit) const noexcept {
        pool_.forEachBlock(levels_[size_t(level)].leaves[leaf], visit);
    }

    uint32_t pointCount(int level, LeafId leaf) const noexcept {
        return levels_[size_t(level)].leaves[leaf].count;
    }
    size_t pointCount(int level) const noexcept { return levels_[size_t(level)].point_count; }
    // It differs whenever the leaf's points do.
    uint32_t revision(int level, LeafId leaf) const noexcept {
        return levels_[size_t(level)].leaves[leaf].revision;
    }

  private:
    static constexpr int kNone = -1;
    struct Level {
        ShellLevel config;
        std::vector<ShellPool::List> leaves;
        size_t point_count = 0;
        std::vector<uint8_t> is_stale;  // per leaf
        std::vector<LeafId> stale;      // the first stale_count: those leaves
        size_t stale_count = 0;

        Level(const ShellLevel& level_config, size_t leaf_count)
            : config(level_config), leaves(leaf_count), is_stale(leaf_count), stale(leaf_count) {}
        void markStale(LeafId leaf) noexcept {
            if (!is_stale[leaf]) stale[stale_count++] = leaf;
            is_stale[leaf] = true;
        }
        // A cell's point depends on N voxels beyond the cell's corners.
        int reach() const noexcept { return config.normals == ShellNormals::kCentralDifference ? 1 : 0; }
    };
    // These are sums over the patches of one block.
    struct BlockSum {
        float area = 0;                                    // m²
        Eigen::Vector3f moment = Eigen::Vector3f::Zero();  // m² × cell steps from the block's first corner
        uint32_t last_patch = 0;
    };

    bool refreshLevel(const VoxelVolume& volume, const LeafLattice& lattice,
                      std::span<const IndexBox> changed_voxels, Level& level, bool is_kept) noexcept;
    bool rebuild(const VoxelVolume& volume, const LeafLattice& lattice, Level& level, LeafId leaf,
                 const IndexBox& touched_cells) noexcept;
    void pointsOfCells(const VoxelVolume& volume, const IndexBox& leaf_cells, ShellNormals normals) noexcept;
    void pointsOfBlocks(const VoxelVolume& volume, const IndexBox& leaf_cells, const IndexBox& blocks,
                        const ShellLevel& level) noexcept;
    void sumBlocks(const IndexBox& blocks, int factor) noexcept;
    SurfacePlace nearestPatchPlace(const VoxelVolume& volume, const IndexBox& leaf_cells,
                                   const Eigen::Vector3i& block_first, const BlockSum& sum,
                                   const Eigen::Vector3f& center) const noexcept;
    void reservePool(const LeafLattice& lattice, size_t spare_points);

    std::vector<Level> levels_;
    int followed_ = 0;
    int prepared_ = kNone;
    ShellProjection projection_;
    ShellPool pool_;

    // These are scratch for one leaf.
    SurfaceCells cells_;
    std::vector<BlockSum> sums_;            // of the blocks being rebuilt, x fastest
    std::vector<uint32_t> previous_patch_;  // per patch: the one before it in the same block
    FreshPoints fresh_;
};

}  // namespace bonemill
