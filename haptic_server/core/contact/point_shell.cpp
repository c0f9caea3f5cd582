#include "haptic_server/core/contact/point_shell.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bonemill {
namespace {

constexpr uint32_t kNoPatch = ~0u;

size_t blocksPerLeaf(const LeafLattice& lattice, int factor) {
    const Eigen::Vector3i blocks = (lattice.leafCells().array() + (factor - 1)) / factor;
    if (blocks.maxCoeff() > BlockKey::kMaxPerAxis)
        throw std::invalid_argument("PointShell: leaves of more than 1024 blocks per axis");
    return size_t(blocks.x()) * size_t(blocks.y()) * size_t(blocks.z());
}

size_t mostBlocksPerLeaf(const LeafLattice& lattice, const ShellConfig& config) {
    size_t most = 0;
    for (const ShellLevel& level : config.levels) most = std::max(most, blocksPerLeaf(lattice, level.factor));
    return most;
}

const ShellConfig& checked(const ShellConfig& config) {
    std::vector<int> factors;
    for (const ShellLevel& level : config.levels) factors.push_back(level.factor);
    std::sort(factors.begin(), factors.end());
    const bool is_distinct = std::adjacent_find(factors.begin(), factors.end()) == factors.end();
    if (factors.empty() || factors.front() < 1 || !is_distinct)
        throw std::invalid_argument("PointShell: scaling factors must be distinct and at least 1");
    return config;
}

// Blocks that hold these cells of a leaf, and the other way round; both count from the leaf's first.
IndexBox blocksOf(const IndexBox& cells, int factor) noexcept {
    return {cells.min / factor, cells.max / factor};
}
IndexBox cellsOf(const IndexBox& blocks, int factor, const Eigen::Vector3i& last_cell) noexcept {
    return {blocks.min * factor, ((blocks.max.array() + 1) * factor - 1).matrix().cwiseMin(last_cell)};
}

IndexBox shifted(const IndexBox& box, const Eigen::Vector3i& by) noexcept {
    return {box.min + by, box.max + by};
}

}  // namespace

PointShell::PointShell(const VoxelVolume& volume, const LeafLattice& lattice, const ShellConfig& config)
    : projection_(volume),
      pool_(mostBlocksPerLeaf(lattice, checked(config))),
      cells_(volume, lattice.leafCells()),
      fresh_(mostBlocksPerLeaf(lattice, config)) {
    size_t most_sums = 0, blocks_per_leaf = 0;
    for (const ShellLevel& level : config.levels) {
        levels_.emplace_back(level, lattice.leafCount());
        const size_t most_points = blocksPerLeaf(lattice, level.factor);
        blocks_per_leaf += most_points / ShellBlock::kCapacity + 1;
        if (level.factor > 1) most_sums = std::max(most_sums, most_points);
    }
    sums_.resize(most_sums);
    if (most_sums > 0) previous_patch_.resize(size_t(lattice.leafCells().prod()));

    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        if (pool_.freeCount() < blocks_per_leaf)
            pool_.addBlocks(std::max(blocks_per_leaf, pool_.blockCount() / 2));
        for (Level& level : levels_) rebuild(volume, lattice, level, leaf, lattice.cellsOf(leaf));
    }
    reservePool(lattice, config.spare_points);
}

// Milled surface also fragments: each leaf it enters wastes up to one block per level.
void PointShell::reservePool(const LeafLattice& lattice, size_t spare_points) {
    size_t spare_blocks = 0;
    for (const Level& level : levels_) {
        const size_t points = spare_points / (size_t(level.config.factor) * size_t(level.config.factor));
        spare_blocks += points / ShellBlock::kCapacity + std::min<size_t>(lattice.leafCount(), 4096);
    }
    if (pool_.freeCount() < spare_blocks) pool_.addBlocks(spare_blocks - pool_.freeCount());
}

int PointShell::levelOf(int factor) const noexcept {
    for (int level = 0; level < levelCount(); ++level)
        if (scalingFactor(level) == factor) return level;
    return -1;
}

bool PointShell::refresh(const VoxelVolume& volume, const LeafLattice& lattice,
                         std::span<const IndexBox> changed_voxels) noexcept {
    bool is_complete = true;
    for (int n = 0; n < levelCount(); ++n)
        is_complete &= refreshLevel(volume, lattice, changed_voxels, levels_[size_t(n)],
                                    n == followed_ || n == prepared_);
    return is_complete;
}

bool PointShell::refreshLevel(const VoxelVolume& volume, const LeafLattice& lattice,
                              std::span<const IndexBox> changed_voxels, Level& level, bool is_kept) noexcept {
    const auto touched_by = [&](const IndexBox& changed) -> IndexBox {
        return {changed.min.array() - (1 + level.reach()), changed.max.array() + level.reach()};
    };
    IndexBox all;
    for (const IndexBox& changed : changed_voxels) all.include(touched_by(changed));
    bool is_complete = true;
    forEachIndex(lattice.leavesOfCells(all), [&](const Eigen::Vector3i& index) {
        const LeafId leaf = lattice.leafId(index);
        const IndexBox leaf_cells = lattice.cellsOf(leaf);
        IndexBox touched;
        for (const IndexBox& changed : changed_voxels)
            touched.include(touched_by(changed).clamped(leaf_cells.min, leaf_cells.max));
        if (touched.isEmpty()) return;
        if (!is_kept) level.markStale(leaf);
        if (!level.is_stale[leaf]) is_complete &= rebuild(volume, lattice, level, leaf, touched);
    });
    return is_complete;
}

PointShell::Preparation PointShell::prepare(const VoxelVolume& volume, const LeafLattice& lattice,
                                            int level_index, int most_leaves) noexcept {
    if (level_index != followed_) prepared_ = level_index;
    Level& level = levels_[size_t(level_index)];
    bool is_complete = true;
    for (int n = 0; n < most_leaves && level.stale_count > 0; ++n) {
        const LeafId leaf = level.stale[--level.stale_count];
        level.is_stale[leaf] = false;
        is_complete &= rebuild(volume, lattice, level, leaf, lattice.cellsOf(leaf));
    }
    return {level.stale_count == 0, is_complete};
}

// `touched_cells` lie in the leaf; their blocks are rebuilt.
bool PointShell::rebuild(const VoxelVolume& volume, const LeafLattice& lattice, Level& level, LeafId leaf,
                         const IndexBox& touched_cells) noexcept {
    const int factor = level.config.factor;
    const IndexBox leaf_cells = lattice.cellsOf(leaf);
    const IndexBox blocks = blocksOf(shifted(touched_cells, -leaf_cells.min), factor);
    fresh_.clear();
    if (lattice.mayHoldSurface(leaf, volume.iso())) {
        const IndexBox cells = cellsOf(blocks, factor, leaf_cells.max - leaf_cells.min);
        cells_.collect(volume, leaf_cells.min, shifted(cells, leaf_cells.min));
        if (factor == 1)
            pointsOfCells(volume, leaf_cells, level.config.normals);
        else if (cells_.count() > 0)
            pointsOfBlocks(volume, leaf_cells, blocks, level.config);
    }
    ShellPool::List& list = level.leaves[leaf];
    level.point_count -= list.count;
    const bool is_stored = pool_.replace(list, BlockKeyBox(blocks), fresh_.points());
    level.point_count += list.count;
    return is_stored;
}

void PointShell::pointsOfCells(const VoxelVolume& volume, const IndexBox& leaf_cells,
                               ShellNormals normals) noexcept {
    cells_.project(projection_);
    for (size_t n = 0; n < cells_.count(); ++n) {
        const bool is_found = cells_.isFound(n);
        if ((is_found && normals == ShellNormals::kTrilinear) || !(cells_.area(n) > 0)) continue;
        SurfacePlace place{leaf_cells.min + cells_.cell(n), cells_.projected(n)};
        if (!is_found) place = projection_.bracket(volume, {place.cell, cells_.centroid(n)});
        cells_.put(n, place.at, projection_.normal(volume, place, normals));
    }
    fresh_.take(cells_.pack(projection_, leaf_cells.min, fresh_.room()));
}

void PointShell::pointsOfBlocks(const VoxelVolume& volume, const IndexBox& leaf_cells, const IndexBox& blocks,
                                const ShellLevel& level) noexcept {
    const int factor = level.factor;
    sumBlocks(blocks, factor);
    const Eigen::Vector3i last_cell = leaf_cells.max - leaf_cells.min;
    const BlockSum* sum = sums_.data();
    for (int z = blocks.min.z(); z <= blocks.max.z(); ++z)
        for (int y = blocks.min.y(); y <= blocks.max.y(); ++y)
            for (int x = blocks.min.x(); x <= blocks.max.x(); ++x, ++sum) {
                if (!(sum->area > 0)) continue;
                const Eigen::Vector3i block(x, y, z);
                const IndexBox cells = cellsOf({block, block}, factor, last_cell);
                const Eigen::Vector3f center = sum->moment / sum->area;
                SurfacePlace place;
                if (!projection_.walk(volume, shifted(cells, leaf_cells.min), center, place))
                    place = nearestPatchPlace(volume, leaf_cells, cells.min, *sum, center);
                fresh_.add({projection_.position(place), projection_.normal(volume, place, level.normals),
                            sum->area, BlockKey::of(block)});
            }
}

// Fills sums_ for `blocks`, x fastest. Each block sums its patches in the order of their cells, whatever else
// is rebuilt with it.
void PointShell::sumBlocks(const IndexBox& blocks, int factor) noexcept {
    const Eigen::Vector3i size = blocks.max - blocks.min + Eigen::Vector3i::Ones();
    std::fill_n(sums_.begin(), size.prod(), BlockSum{.last_patch = kNoPatch});
    for (size_t n = 0; n < cells_.count(); ++n) {
        if (!(cells_.area(n) > 0)) continue;
        const Eigen::Vector3i cell = cells_.cell(n);
        const Eigen::Vector3i block = cell / factor;
        BlockSum& sum = sums_[placeIn(size, block - blocks.min)];
        const Eigen::Vector3f from_first = (cell - block * factor).cast<float>() + cells_.centroid(n);
        sum.area += cells_.area(n);
        sum.moment += cells_.area(n) * from_first;
        previous_patch_[n] = sum.last_patch;
        sum.last_patch = uint32_t(n);
    }
}

// The place lies on the surface in the cell of the block whose patch is nearest to `center`.
SurfacePlace PointShell::nearestPatchPlace(const VoxelVolume& volume, const IndexBox& leaf_cells,
                                           const Eigen::Vector3i& block_first, const BlockSum& sum,
                                           const Eigen::Vector3f& center) const noexcept {
    uint32_t nearest = sum.last_patch;
    float least = INFINITY;
    for (uint32_t n = sum.last_patch; n != kNoPatch; n = previous_patch_[n]) {
        const Eigen::Vector3f from_first = (cells_.cell(n) - block_first).cast<float>() + cells_.centroid(n);
        const float squared = (from_first - center).cwiseProduct(projection_.spacing()).squaredNorm();
        if (squared >= least) continue;
        nearest = n;
        least = squared;
    }
    return projection_.bracket(volume, {leaf_cells.min + cells_.cell(nearest), cells_.centroid(nearest)});
}

}  // namespace bonemill
