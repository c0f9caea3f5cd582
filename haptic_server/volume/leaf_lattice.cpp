#include "haptic_server/volume/leaf_lattice.h"

#include <algorithm>

namespace bonemill {
namespace {

template <class Visit>
void forEachIndex(const IndexBox& box, Visit&& visit) noexcept {
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j)
            for (int i = box.min.x(); i <= box.max.x(); ++i) visit(Eigen::Vector3i(i, j, k));
}

void widen(DensityRange& range, const DensityRange& other) noexcept {
    range.min = std::min(range.min, other.min);
    range.max = std::max(range.max, other.max);
}

}  // namespace

Eigen::Vector3i LeafLattice::leafCellsOfDepth(const VolumeGeometry& geometry, int depth) {
    const int leaves = 1 << depth;
    const Eigen::Array3i cells = geometry.dims.array() + 1;
    return (cells + leaves - 1) / leaves;
}

LeafLattice::LeafLattice(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells)
    : leaf_cells_(leaf_cells), dims_(volume.dims()) {
    const Eigen::Array3i cells = dims_.array() + 1;
    Eigen::Vector3i nodes = (cells + leaf_cells.array() - 1) / leaf_cells.array();
    for (;;) {
        levels_.push_back({nodes, std::vector<DensityRange>(size_t(nodes.prod()))});
        if (nodes.maxCoeff() == 1) break;
        nodes = ((nodes.array() + 1) / 2).matrix();
    }
    versions_ = std::vector<std::atomic<uint32_t>>(leafCount());
    for (LeafId id = 0; id < leafCount(); ++id) levels_[0].range[id] = scanLeaf(volume, id);
    refreshParents({Eigen::Vector3i::Zero(), leavesPerAxis().array() - 1});
}

IndexBox LeafLattice::cellsOf(LeafId id) const noexcept {
    const Eigen::Vector3i low = leafIndex(id).cwiseProduct(leaf_cells_).array() - 1;
    const Eigen::Vector3i high = (low + leaf_cells_).array() - 1;
    return {low, high.cwiseMin((dims_.array() - 1).matrix())};
}

IndexBox LeafLattice::leavesOfCells(const IndexBox& cells) const noexcept {
    const IndexBox inside = cells.clamped(Eigen::Vector3i::Constant(-1), dims_.array() - 1);
    if (inside.isEmpty()) return {};
    return {(inside.min.array() + 1) / leaf_cells_.array(), (inside.max.array() + 1) / leaf_cells_.array()};
}

DensityRange LeafLattice::scanLeaf(const VoxelVolume& volume, LeafId id) const noexcept {
    const IndexBox cells = cellsOf(id);
    DensityRange range;
    for (int k = cells.min.z(); k <= cells.max.z() + 1; ++k)
        for (int j = cells.min.y(); j <= cells.max.y() + 1; ++j) {
            const size_t row = volume.offset(cells.min.x(), j, k);
            const int count = cells.max.x() + 2 - cells.min.x();
            for (int i = 0; i < count; ++i) {
                const Density d = volume.at(row + size_t(i));
                range.min = std::min(range.min, d);
                range.max = std::max(range.max, d);
            }
        }
    return range;
}

void LeafLattice::refreshParents(const IndexBox& leaves) noexcept {
    IndexBox nodes = leaves;
    for (size_t level = 1; level < levels_.size(); ++level) {
        nodes = {nodes.min / 2, nodes.max / 2};
        const Level& below = levels_[level - 1];
        Level& here = levels_[level];
        forEachIndex(nodes, [&](const Eigen::Vector3i& node) {
            DensityRange range;
            for (int octant = 0; octant < 8; ++octant) {
                const Eigen::Vector3i child =
                    2 * node + Eigen::Vector3i(octant & 1, octant >> 1 & 1, octant >> 2 & 1);
                if ((child.array() >= below.nodes.array()).any()) continue;
                widen(range, below.range[size_t(child.x() + below.nodes.x() *
                                                                (child.y() + below.nodes.y() * child.z()))]);
            }
            here.range[size_t(node.x() + here.nodes.x() * (node.y() + here.nodes.y() * node.z()))] = range;
        });
    }
}

void LeafLattice::refreshRanges(const VoxelVolume& volume, const IndexBox& changed_voxels) noexcept {
    // A voxel is a corner of the cells on both its sides.
    const IndexBox leaves = leavesOfCells({changed_voxels.min.array() - 1, changed_voxels.max});
    if (leaves.isEmpty()) return;
    forEachIndex(leaves, [&](const Eigen::Vector3i& leaf) {
        const LeafId id = leafId(leaf);
        levels_[0].range[id] = scanLeaf(volume, id);
    });
    refreshParents(leaves);
}

void LeafLattice::beginWrite(const IndexBox& changed_voxels) noexcept {
    const IndexBox leaves = leavesOfCells(
        {changed_voxels.min.array() - kInfluence, changed_voxels.max.array() + (kInfluence - 1)});
    if (leaves.isEmpty()) return;
    forEachIndex(leaves, [&](const Eigen::Vector3i& leaf) {
        auto& version = versions_[leafId(leaf)];
        // Relaxed is enough: the voxels' own release stores keep the odd version before them.
        version.store(version.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    });
}

void LeafLattice::endWrite(const IndexBox& changed_voxels) noexcept {
    const IndexBox leaves = leavesOfCells(
        {changed_voxels.min.array() - kInfluence, changed_voxels.max.array() + (kInfluence - 1)});
    if (leaves.isEmpty()) return;
    forEachIndex(leaves, [&](const Eigen::Vector3i& leaf) {
        auto& version = versions_[leafId(leaf)];
        version.store(version.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    });
}

}  // namespace bonemill
