#include "haptic_server/core/volume/leaf_lattice.h"

#include <algorithm>

#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {
namespace {

void widen(DensityRange& range, const DensityRange& other) noexcept {
    range.min = std::min(range.min, other.min);
    range.max = std::max(range.max, other.max);
}

// Returns the range of the voxels in `box` joined with `known`. Stops as soon as it is `bounds`, which
// it cannot exceed.
DensityRange scan(const VoxelVolume& volume, const IndexBox& box, DensityRange known,
                  const DensityRange& bounds) noexcept {
    volume.forEachPart(box, [&](const IndexBox& part, size_t offset) {
        if (const auto uniform = volume.uniformDensity(part.min)) return widen(known, {*uniform, *uniform});
        const Eigen::Vector3i size = part.max - part.min + Eigen::Vector3i::Ones();
        for (int k = 0; k < size.z() && known != bounds; ++k, offset += VoxelVolume::kStrideZ)
            kernels().range_of_rows(volume.ownerData() + offset, size.x(), VoxelVolume::kStrideY, size.y(),
                                    known.min, known.max);
    });
    return known;
}

constexpr DensityRange kAnyDensity{0, kMaxDensity};

// Returns the range of a leaf's voxels after a change in `changed`, from its range before. What did not
// change lies in the old range, so no more can come out than that joined with the changed voxels' range;
// mostly a few rows show that no less comes out either.
DensityRange rangeAfterChange(const VoxelVolume& volume, const IndexBox& voxels, const IndexBox& changed,
                              const DensityRange& before, int direction) noexcept {
    DensityRange known = scan(volume, changed.clamped(voxels.min, voxels.max), {}, kAnyDensity);
    DensityRange bounds = before;
    widen(bounds, known);
    // A voxel of the least density before is not above it now, and the same the other way round.
    if (direction < 0) known.min = bounds.min;
    if (direction > 0) known.max = bounds.max;
    return scan(volume, voxels, known, bounds);
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
    for (LeafId id = 0; id < leafCount(); ++id)
        levels_[0].range[id] = scan(volume, voxelsOf(id), {}, kAnyDensity);
    refreshParents({Eigen::Vector3i::Zero(), leavesPerAxis().array() - 1});
}

IndexBox LeafLattice::cellsOf(LeafId id) const noexcept {
    BONEMILL_ASSERT(id < leafCount());
    const Eigen::Vector3i low = leafIndex(id).cwiseProduct(leaf_cells_).array() - 1;
    const Eigen::Vector3i high = (low + leaf_cells_).array() - 1;
    return {low, high.cwiseMin((dims_.array() - 1).matrix())};
}

IndexBox LeafLattice::leavesOfCells(const IndexBox& cells) const noexcept {
    const IndexBox inside = cells.clamped(Eigen::Vector3i::Constant(-1), dims_.array() - 1);
    if (inside.isEmpty()) return {};
    return {(inside.min.array() + 1) / leaf_cells_.array(), (inside.max.array() + 1) / leaf_cells_.array()};
}

void LeafLattice::refreshParents(const IndexBox& leaves) noexcept {
    IndexBox nodes = leaves;
    bool has_changed = true;
    for (size_t level = 1; level < levels_.size() && has_changed; ++level) {
        has_changed = false;
        nodes = {nodes.min / 2, nodes.max / 2};
        const Level& below = levels_[level - 1];
        Level& here = levels_[level];
        forEachIndex(nodes, [&](const Eigen::Vector3i& node) {
            DensityRange range;
            for (int octant = 0; octant < 8; ++octant) {
                const Eigen::Vector3i child =
                    2 * node + Eigen::Vector3i(octant & 1, octant >> 1 & 1, octant >> 2 & 1);
                if ((child.array() >= below.nodes.array()).any()) continue;
                widen(range, below.range[placeIn(below.nodes, child)]);
            }
            DensityRange& old = here.range[placeIn(here.nodes, node)];
            has_changed |= old != range;
            old = range;
        });
    }
}

void LeafLattice::refreshRanges(const VoxelVolume& volume, const IndexBox& changed_voxels,
                                int direction) noexcept {
    // A voxel is a corner of the cells on both its sides.
    const IndexBox leaves = leavesOfCells({changed_voxels.min.array() - 1, changed_voxels.max});
    if (leaves.isEmpty()) return;
    bool has_changed = false;
    forEachIndex(leaves, [&](const Eigen::Vector3i& leaf) {
        const LeafId id = leafId(leaf);
        DensityRange& range = levels_[0].range[id];
        const DensityRange now = rangeAfterChange(volume, voxelsOf(id), changed_voxels, range, direction);
        has_changed |= range != now;
        range = now;
    });
    if (has_changed) refreshParents(leaves);
}

void LeafLattice::beginWrite(const IndexBox& changed_voxels) noexcept {
    ++write_count_;
    forEachIndex(leavesOfWrite(changed_voxels), [&](const Eigen::Vector3i& leaf) {
        auto& version = versions_[leafId(leaf)];
        // Relaxed is enough: the voxels' own release stores keep the odd version before them.
        version.store(version.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    });
}

void LeafLattice::endWrite(const IndexBox& changed_voxels) noexcept {
    forEachIndex(leavesOfWrite(changed_voxels), [&](const Eigen::Vector3i& leaf) {
        auto& version = versions_[leafId(leaf)];
        version.store(version.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    });
}

}  // namespace bonemill
