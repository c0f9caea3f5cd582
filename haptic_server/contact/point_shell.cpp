#include "haptic_server/contact/point_shell.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace bonemill {
namespace {

constexpr uint32_t kNoPatch = ~0u;

size_t blocksPerLeaf(const LeafLattice& lattice, int factor) {
    const Eigen::Vector3i blocks = (lattice.leafCells().array() + (factor - 1)) / factor;
    if (blocks.maxCoeff() > 1 << kShellKeyBits)
        throw std::invalid_argument("PointShell: leaves of more than 1024 blocks per axis");
    return size_t(blocks.x()) * size_t(blocks.y()) * size_t(blocks.z());
}

size_t mostBlocksPerLeaf(const LeafLattice& lattice, const ShellConfig& config) {
    size_t most = 0;
    for (const int factor : config.factors) most = std::max(most, blocksPerLeaf(lattice, factor));
    return most;
}

const ShellConfig& checked(const ShellConfig& config) {
    std::vector<int> factors = config.factors;
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

Eigen::Vector3i cellOf(const SurfacePatch& patch) noexcept {
    return {patch.cell[0], patch.cell[1], patch.cell[2]};
}

bool holds(const IndexBox& box, const Eigen::Vector3i& index) noexcept {
    return (index.array() >= box.min.array()).all() && (index.array() <= box.max.array()).all();
}

}  // namespace

PointShell::PointShell(const VoxelVolume& volume, const LeafLattice& lattice, const ShellConfig& config)
    : projection_(volume, checked(config).normals),
      reach_(config.normals == ShellNormals::kCentralDifference ? 1 : 0),
      pool_(mostBlocksPerLeaf(lattice, config)),
      cells_(volume, lattice.leafCells()) {
    for (const int factor : config.factors)
        levels_.push_back({factor, std::vector<ShellPool::List>(lattice.leafCount())});
    fresh_.resize(mostBlocksPerLeaf(lattice, config));
    size_t most_sums = 0;
    for (const int factor : config.factors)
        if (factor > 1) most_sums = std::max(most_sums, blocksPerLeaf(lattice, factor));
    sums_.resize(most_sums);
    if (most_sums > 0) previous_patch_.resize(size_t(lattice.leafCells().prod()));

    size_t blocks_per_leaf = 0;
    for (const int factor : config.factors)
        blocks_per_leaf += blocksPerLeaf(lattice, factor) / ShellBlock::kCapacity + 1;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        if (pool_.freeCount() < blocks_per_leaf)
            pool_.addBlocks(std::max(blocks_per_leaf, pool_.blockCount() / 2));
        rebuild(volume, lattice, leaf, lattice.cellsOf(leaf));
    }
    reservePool(lattice, config.spare_points);
}

// Milled surface also fragments: each leaf it enters wastes up to one block per level.
void PointShell::reservePool(const LeafLattice& lattice, size_t spare_points) {
    size_t spare_blocks = 0;
    for (const Level& level : levels_) {
        const size_t points = spare_points / (size_t(level.factor) * size_t(level.factor));
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
                         const IndexBox& changed_voxels) noexcept {
    if (changed_voxels.isEmpty()) return true;
    const IndexBox cells{changed_voxels.min.array() - (1 + reach_), changed_voxels.max.array() + reach_};
    const IndexBox leaves = lattice.leavesOfCells(cells);
    bool is_complete = true;
    for (int k = leaves.min.z(); k <= leaves.max.z(); ++k)
        for (int j = leaves.min.y(); j <= leaves.max.y(); ++j)
            for (int i = leaves.min.x(); i <= leaves.max.x(); ++i) {
                const LeafId leaf = lattice.leafId({i, j, k});
                const IndexBox leaf_cells = lattice.cellsOf(leaf);
                is_complete &= rebuild(volume, lattice, leaf, cells.clamped(leaf_cells.min, leaf_cells.max));
            }
    return is_complete;
}

// `touched_cells` lie in the leaf; their blocks of every level are rebuilt.
bool PointShell::rebuild(const VoxelVolume& volume, const LeafLattice& lattice, LeafId leaf,
                         const IndexBox& touched_cells) noexcept {
    const IndexBox leaf_cells = lattice.cellsOf(leaf);
    const IndexBox touched = shifted(touched_cells, -leaf_cells.min);
    const Eigen::Vector3i last_cell = leaf_cells.max - leaf_cells.min;
    IndexBox wanted = touched;
    for (const Level& level : levels_) {
        const IndexBox cells = cellsOf(blocksOf(touched, level.factor), level.factor, last_cell);
        wanted = {wanted.min.cwiseMin(cells.min), wanted.max.cwiseMax(cells.max)};
    }
    if (lattice.mayHoldSurface(leaf, volume.iso()))
        cells_.collect(volume, leaf_cells.min, shifted(wanted, leaf_cells.min));
    else
        cells_.clear();
    bool is_complete = true;
    for (Level& level : levels_)
        is_complete &= rebuildLevel(volume, leaf_cells, blocksOf(touched, level.factor), level, leaf);
    return is_complete;
}

bool PointShell::rebuildLevel(const VoxelVolume& volume, const IndexBox& leaf_cells, const IndexBox& blocks,
                              Level& level, LeafId leaf) noexcept {
    fresh_size_ = 0;
    if (level.factor == 1)
        pointsOfCells(volume, leaf_cells, blocks);
    else if (!cells_.patches().empty())
        pointsOfBlocks(volume, leaf_cells, blocks, level.factor);
    ShellPool::List& list = level.leaves[leaf];
    level.point_count -= list.count;
    const bool is_stored = pool_.replace(list, blocks, {fresh_.data(), fresh_size_});
    level.point_count += list.count;
    return is_stored;
}

void PointShell::pointsOfCells(const VoxelVolume& volume, const IndexBox& leaf_cells,
                               const IndexBox& cells) noexcept {
    for (const SurfacePatch& patch : cells_.patches()) {
        const Eigen::Vector3i local = cellOf(patch);
        if (!holds(cells, local)) continue;
        const Eigen::Vector3i cell = leaf_cells.min + local;
        SurfacePlace place;
        if (!projection_.walk(volume, {cell, cell}, patch.centroid, place))
            place = projection_.bracket(volume, {cell, patch.centroid});
        addPoint(volume, place, patch.area, local);
    }
}

void PointShell::pointsOfBlocks(const VoxelVolume& volume, const IndexBox& leaf_cells, const IndexBox& blocks,
                                int factor) noexcept {
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
                addPoint(volume, place, sum->area, block);
            }
}

// Fills sums_ for `blocks`, x fastest. Each block sums its patches in the order of their cells, whatever else
// is rebuilt with it.
void PointShell::sumBlocks(const IndexBox& blocks, int factor) noexcept {
    const Eigen::Vector3i size = blocks.max - blocks.min + Eigen::Vector3i::Ones();
    std::fill_n(sums_.begin(), size.prod(), BlockSum{.last_patch = kNoPatch});
    const std::span<const SurfacePatch> patches = cells_.patches();
    for (size_t n = 0; n < patches.size(); ++n) {
        const Eigen::Vector3i cell = cellOf(patches[n]);
        const Eigen::Vector3i block = cell / factor;
        if (!holds(blocks, block)) continue;
        const Eigen::Vector3i at = block - blocks.min;
        BlockSum& sum =
            sums_[size_t(at.x()) + size_t(size.x()) * (size_t(at.y()) + size_t(size.y()) * size_t(at.z()))];
        const Eigen::Vector3f from_first = (cell - block * factor).cast<float>() + patches[n].centroid;
        sum.area += patches[n].area;
        sum.moment += patches[n].area * from_first;
        previous_patch_[n] = sum.last_patch;
        sum.last_patch = uint32_t(n);
    }
}

// On the surface in the cell of the block whose patch is nearest to `center`.
SurfacePlace PointShell::nearestPatchPlace(const VoxelVolume& volume, const IndexBox& leaf_cells,
                                           const Eigen::Vector3i& block_first, const BlockSum& sum,
                                           const Eigen::Vector3f& center) const noexcept {
    const SurfacePatch* nearest = nullptr;
    float least = INFINITY;
    for (uint32_t n = sum.last_patch; n != kNoPatch; n = previous_patch_[n]) {
        const SurfacePatch& patch = cells_.patches()[n];
        const Eigen::Vector3f from_first = (cellOf(patch) - block_first).cast<float>() + patch.centroid;
        const float squared = (from_first - center).cwiseProduct(projection_.spacing()).squaredNorm();
        if (nearest && squared >= least) continue;
        nearest = &patch;
        least = squared;
    }
    return projection_.bracket(volume, {leaf_cells.min + cellOf(*nearest), nearest->centroid});
}

void PointShell::addPoint(const VoxelVolume& volume, const SurfacePlace& place, float area,
                          const Eigen::Vector3i& block) noexcept {
    fresh_[fresh_size_++] = {projection_.position(place), projection_.normal(volume, place), area,
                             packShellKey(block)};
}

}  // namespace bonemill
