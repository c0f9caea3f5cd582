#include "haptic_server/contact/point_shell.h"

#include <algorithm>
#include <stdexcept>

#include "haptic_server/contact/shell_point.h"

namespace bonemill {
namespace {

constexpr int kKeyBits = 10;  // blocks per axis of a leaf: at most 1024

uint32_t packKey(int x, int y, int z) noexcept {
    return uint32_t(x | y << kKeyBits | z << 2 * kKeyBits);
}

bool isInside(uint32_t key, const IndexBox& blocks) noexcept {
    constexpr int kMask = (1 << kKeyBits) - 1;
    const Eigen::Vector3i at(int(key) & kMask, int(key) >> kKeyBits & kMask,
                             int(key) >> 2 * kKeyBits & kMask);
    return (at.array() >= blocks.min.array()).all() && (at.array() <= blocks.max.array()).all();
}

// What a column of voxels (one x, the block's y and z range) holds; combined over the block's columns: a
// block with voxels on both sides of the iso-surface has a crossed edge.
enum ColumnState : uint8_t { kNoneInside = 0, kSomeInside = 1, kAllInside = 2 };

// States of the columns x = box.min.x .. box.max.x; `states` holds that many.
void classifyColumns(const VoxelVolume& volume, const IndexBox& box, uint8_t* states) noexcept {
    const Density iso = volume.iso();
    const int columns = box.max.x() - box.min.x() + 1;
    std::fill_n(states, columns, uint8_t(kAllInside));
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j) {
            const size_t row = volume.offset(box.min.x(), j, k);
            for (int i = 0; i < columns; ++i) {
                const bool inside = volume.at(row + size_t(i)) >= iso;
                states[i] = inside ? states[i] | kSomeInside : states[i] & ~kAllInside;
            }
        }
}

bool isCrossed(const uint8_t* states, int columns) noexcept {
    uint8_t any = 0;
    uint8_t all = kAllInside;
    for (int i = 0; i < columns; ++i) {
        any |= states[i];
        all &= states[i];
    }
    return (any & kSomeInside) && !(all & kAllInside);
}

Eigen::Vector3i blocksOf(const IndexBox& cells, int s) noexcept {
    return ((cells.max - cells.min).array() / s + 1).matrix();
}

}  // namespace

PointShell::PointShell(const VoxelVolume& volume, const LeafLattice& lattice, int scaling_factor,
                       size_t spare_points)
    : scaling_factor_(scaling_factor), leaves_(lattice.leafCount()) {
    const Eigen::Vector3i most =
        ((lattice.leafCells().array() + scaling_factor - 1) / scaling_factor).matrix();
    if (most.maxCoeff() > 1 << kKeyBits)
        throw std::invalid_argument("PointShell: leaves of more than 1024 blocks per axis");
    fresh_.resize(size_t(most.prod()));
    merged_.resize(fresh_.size());
    row_.resize(size_t(lattice.leafCells().x()) + 1);

    const auto add_blocks = [this](size_t count) {
        const size_t old = blocks_.size();
        blocks_.resize(old + count);
        for (size_t b = old; b < blocks_.size(); ++b) {
            blocks_[b].next = free_blocks_;
            free_blocks_ = uint32_t(b);
        }
        free_count_ += uint32_t(count);
    };
    const size_t blocks_per_leaf = fresh_.size() / ShellBlock::kCapacity + 1;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        if (free_count_ < blocks_per_leaf) add_blocks(std::max(blocks_per_leaf, blocks_.size() / 2));
        const IndexBox cells = lattice.cellsOf(leaf);
        const IndexBox all{Eigen::Vector3i::Zero(), blocksOf(cells, scaling_factor_).array() - 1};
        collectNew(volume, cells, all);
        mergeWithOld(leaf, all);
        store(leaf);
    }
    // Milled surface also fragments: each leaf it enters wastes up to one block.
    const size_t spare_blocks =
        spare_points / ShellBlock::kCapacity + std::min<size_t>(lattice.leafCount(), 4096);
    if (free_count_ < spare_blocks) add_blocks(spare_blocks - free_count_);
}

bool PointShell::refresh(const VoxelVolume& volume, const LeafLattice& lattice,
                         const IndexBox& changed_voxels) noexcept {
    if (changed_voxels.isEmpty()) return true;
    const IndexBox cells{changed_voxels.min.array() - LeafLattice::kInfluence,
                         changed_voxels.max.array() + (LeafLattice::kInfluence - 1)};
    const IndexBox leaves = lattice.leavesOfCells(cells);
    bool all_stored = true;
    for (int k = leaves.min.z(); k <= leaves.max.z(); ++k)
        for (int j = leaves.min.y(); j <= leaves.max.y(); ++j)
            for (int i = leaves.min.x(); i <= leaves.max.x(); ++i) {
                const LeafId leaf = lattice.leafId({i, j, k});
                const IndexBox leaf_cells = lattice.cellsOf(leaf);
                const IndexBox touched = cells.clamped(leaf_cells.min, leaf_cells.max);
                const IndexBox blocks{(touched.min - leaf_cells.min) / scaling_factor_,
                                      (touched.max - leaf_cells.min) / scaling_factor_};
                fresh_size_ = 0;
                if (lattice.mayHoldSurface(leaf, volume.iso())) collectNew(volume, leaf_cells, blocks);
                mergeWithOld(leaf, blocks);
                all_stored = store(leaf) && all_stored;
            }
    return all_stored;
}

void PointShell::collectNew(const VoxelVolume& volume, const IndexBox& leaf_cells,
                            const IndexBox& blocks) noexcept {
    const auto cells_of = [&](int x, int y, int z) {
        const Eigen::Vector3i first = leaf_cells.min + scaling_factor_ * Eigen::Vector3i(x, y, z);
        return IndexBox{first, (first.array() + (scaling_factor_ - 1)).matrix().cwiseMin(leaf_cells.max)};
    };
    fresh_size_ = 0;
    for (int z = blocks.min.z(); z <= blocks.max.z(); ++z)
        for (int y = blocks.min.y(); y <= blocks.max.y(); ++y) {
            IndexBox row = cells_of(blocks.min.x(), y, z);
            row.max = cells_of(blocks.max.x(), y, z).max.array() + 1;  // cells to voxels
            classifyColumns(volume, row, row_.data());
            for (int x = blocks.min.x(); x <= blocks.max.x(); ++x) {
                const IndexBox cells = cells_of(x, y, z);
                const int columns = cells.max.x() - cells.min.x() + 2;
                if (!isCrossed(row_.data() + (cells.min.x() - row.min.x()), columns)) continue;
                ShellPoint& point = fresh_[fresh_size_++];
                point = makeShellPoint(volume, cells);
                point.key = packKey(x, y, z);
            }
        }
}

void PointShell::mergeWithOld(LeafId leaf, const IndexBox& blocks) noexcept {
    merged_size_ = 0;
    size_t next_fresh = 0;
    forEachBlock(leaf, [&](const ShellBlock& block, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) {
            if (isInside(block.key[i], blocks)) continue;
            while (next_fresh < fresh_size_ && fresh_[next_fresh].key < block.key[i])
                merged_[merged_size_++] = fresh_[next_fresh++];
            merged_[merged_size_++] = {
                {block.x[i], block.y[i], block.z[i]}, {block.nx[i], block.ny[i], block.nz[i]}, block.key[i]};
        }
    });
    while (next_fresh < fresh_size_) merged_[merged_size_++] = fresh_[next_fresh++];
}

bool PointShell::store(LeafId id) noexcept {
    Leaf& leaf = leaves_[id];
    const uint32_t have = (leaf.count + ShellBlock::kCapacity - 1) / ShellBlock::kCapacity;
    const uint32_t want = (uint32_t(merged_size_) + ShellBlock::kCapacity - 1) / ShellBlock::kCapacity;
    if (want > have && want - have > free_count_) return false;
    for (uint32_t n = have; n < want; ++n) {
        const uint32_t block = takeBlock();
        blocks_[block].next = leaf.first;
        leaf.first = block;
    }
    for (uint32_t n = want; n < have; ++n) {
        const uint32_t block = leaf.first;
        leaf.first = blocks_[block].next;
        blocks_[block].next = free_blocks_;
        free_blocks_ = block;
        ++free_count_;
    }
    uint32_t block = leaf.first;
    for (size_t n = 0; n < merged_size_; ++n) {
        const uint32_t i = uint32_t(n) % ShellBlock::kCapacity;
        if (n > 0 && i == 0) block = blocks_[block].next;
        ShellBlock& b = blocks_[block];
        const ShellPoint& point = merged_[n];
        b.x[i] = point.position.x(), b.y[i] = point.position.y(), b.z[i] = point.position.z();
        b.nx[i] = point.normal.x(), b.ny[i] = point.normal.y(), b.nz[i] = point.normal.z();
        b.key[i] = point.key;
    }
    point_count_ += merged_size_;
    point_count_ -= leaf.count;
    leaf.count = uint32_t(merged_size_);
    return true;
}

uint32_t PointShell::takeBlock() noexcept {
    const uint32_t block = free_blocks_;
    free_blocks_ = blocks_[block].next;
    --free_count_;
    return block;
}

}  // namespace bonemill
