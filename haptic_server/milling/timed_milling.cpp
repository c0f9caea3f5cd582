#include "haptic_server/milling/timed_milling.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

constexpr int64_t kCellsLookedAtPerWorkedOn = 8;  // so much quicker

// Voxels of the box around a sphere, writable ones only; empty if the sphere is elsewhere.
IndexBox boxAround(const VoxelVolume& volume, const Eigen::Vector3d& p_VB, double radius) noexcept {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    const Eigen::Array3d low = ((p_VB.array() - radius) / spacing).max(0.0).min(dims);
    const Eigen::Array3d high = ((p_VB.array() + radius) / spacing).max(-1.0).min(dims - 1);
    return {low.ceil().cast<int>().matrix(), high.floor().cast<int>().matrix()};
}

// Of the nearest point of a box of voxels.
double squaredDistance(const VoxelVolume& volume, const IndexBox& voxels,
                       const Eigen::Vector3d& p_VB) noexcept {
    const Eigen::Array3d low = volume.spacing().array() * voxels.min.cast<double>().array() - p_VB.array();
    const Eigen::Array3d high = p_VB.array() - volume.spacing().array() * voxels.max.cast<double>().array();
    return low.max(high).max(0.0).matrix().squaredNorm();
}

// That a burr of this radius can change.
Eigen::Vector3i mostVoxels(const VoxelVolume& volume, double burr_radius) noexcept {
    const auto reach = [&](int direction) {
        return BurrLimit(volume, burr_radius, MillingShape::kSubVoxel, direction).reach();
    };
    const double farthest = std::max(reach(-1), reach(+1));
    const Eigen::Array3d voxels = (2 * farthest / volume.spacing().array()).floor() + 2;
    return voxels.min(volume.dims().cast<double>().array()).cast<int>().matrix();
}

bool isFinished(const DensityRange& range, int direction) noexcept {
    return direction < 0 ? range.max == 0 : range.min == kMaxDensity;
}

}  // namespace

TimedMilling::TimedMilling(const MillingConfig& config, const VoxelVolume& volume, const LeafLattice& lattice,
                           double largest_burr_radius)
    : config_(config),
      largest_burr_radius_(largest_burr_radius),
      burr_radius_(largest_burr_radius),
      changes_(lattice, mostVoxels(volume, largest_burr_radius)) {}

MillingResult TimedMilling::apply(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell,
                                  const Eigen::Vector3d& p_VB, int direction, double dt) noexcept {
    MillingResult result;
    if (!config_.enabled || direction == 0) return result;
    if (direction != carry_direction_) carry_ = 0;
    carry_direction_ = direction;
    carry_ += (direction < 0 ? config_.removal_rate : config_.addition_rate) * dt;
    const int amount = int(std::min(carry_, double(kMaxDensity)));
    carry_ -= std::floor(carry_);
    if (amount == 0) return result;

    collectChanges(volume, lattice,
                   {p_VB, direction, amount, BurrLimit(volume, burr_radius_, config_.shape, direction)},
                   result);
    if (!changes_.isEmpty()) result.shell_is_complete = changes_.write(volume, lattice, shell, direction);
    return result;
}

// Leaf by leaf and brick by brick, from where the last tick was cut short to the last leaf, then the leaves
// before it.
void TimedMilling::collectChanges(VoxelVolume& volume, const LeafLattice& lattice, const Stroke& stroke,
                                  MillingResult& result) noexcept {
    changes_.clear();
    cells_ = 0;
    const double reach_squared = stroke.limit.reach() * stroke.limit.reach();
    const IndexBox box = boxAround(volume, stroke.p_VB, stroke.limit.reach());
    const auto is_wanted = [&](const DensityRange& range, const IndexBox& voxels) {
        return !isFinished(range, stroke.direction) &&
               squaredDistance(volume, voxels, stroke.p_VB) < reach_squared;
    };
    const LeafId first = std::exchange(next_leaf_, kNoLeaf);
    const int first_part = next_part_;
    for (const bool is_second_round : {false, true}) {
        if (is_second_round && first == kNoLeaf) break;
        bool is_later = first == kNoLeaf;
        // A voxel is the first corner of its cell.
        lattice.forEachLeaf(box, is_wanted, [&](LeafId leaf) {
            is_later |= leaf == first;
            if (is_later == is_second_round || result.is_cut_short) return;
            const IndexBox voxels = lattice.cellsOf(leaf).clamped(box.min, box.max);
            next_part_ = collectLeaf(volume, voxels, leaf == first ? first_part : 0, stroke, result);
            if (next_part_ == kAllParts) return;
            next_leaf_ = leaf;
            result.is_cut_short = true;
        });
    }
}

// From one of its parts on. The part for which there was no time, or kAllParts.
int TimedMilling::collectLeaf(VoxelVolume& volume, const IndexBox& voxels, int first_part,
                              const Stroke& stroke, MillingResult& result) noexcept {
    int n = 0, left = kAllParts;
    MillingResult of_leaf;
    volume.forEachOwnedPart(voxels, [&](const IndexBox& part, size_t offset) {
        const int index = n++;
        if (index < first_part || left != kAllParts) return;
        if (!collectPart(volume, part, offset, stroke, of_leaf)) left = index;
    });
    if (!of_leaf.changed.isEmpty()) changes_.closeLeaf(of_leaf.changed);
    result.include(of_leaf);
    return left;
}

// False: it would take more than a tick's cells, and nothing of it is kept; nor without memory for its
// bricks.
bool TimedMilling::collectPart(VoxelVolume& volume, const IndexBox& part, size_t offset, const Stroke& stroke,
                               MillingResult& of_leaf) noexcept {
    const ChangedRuns::Mark before = changes_.mark();
    MillingResult of_part;
    IndexBox plane = part;
    const double reach_squared = stroke.limit.reach() * stroke.limit.reach();
    for (int k = part.min.z(); k <= part.max.z(); ++k, offset += VoxelVolume::kStrideZ) {
        plane.min.z() = plane.max.z() = k;
        if (squaredDistance(volume, plane, stroke.p_VB) >= reach_squared) continue;
        collectPlane(volume, plane, offset, stroke, of_part);
    }
    const size_t cells_before = std::exchange(
        cells_, cells_ + size_t(part.count() / kCellsLookedAtPerWorkedOn + of_part.changed.count()));
    if (cells_ > config_.most_cells && cells_before > 0) {
        changes_.backTo(before);
        return false;
    }
    if (of_part.changed.isEmpty()) return true;
    if (!volume.openBricksIn(of_part.changed)) {
        changes_.backTo(before);
        of_leaf.has_room = false;
        return true;
    }
    of_leaf.include(of_part);
    return true;
}

void TimedMilling::collectPlane(const VoxelVolume& volume, const IndexBox& plane, size_t offset,
                                const Stroke& stroke, MillingResult& result) noexcept {
    const Eigen::Vector3d to_first = volume.spacing().cwiseProduct(plane.min.cast<double>()) - stroke.p_VB;
    const BurrPlane burr = stroke.limit.plane(to_first, volume.spacing(), stroke.amount);
    const Density* old = volume.ownerData() + offset;
    Density fresh[kBrickCells * kBrickCells];
    const int count = plane.max.x() - plane.min.x() + 1, rows = plane.max.y() - plane.min.y() + 1;
    const auto mill = stroke.direction < 0 ? kernels().remove_plane : kernels().add_plane;
    const MilledPlane milled = mill(burr, old, count, rows, fresh);
    for (int r = 0; r < rows; ++r)
        if (milled.is_changed >> r & 1)
            changes_.add(plane.min + Eigen::Vector3i(0, r, 0), count, old + VoxelVolume::kStrideY * size_t(r),
                         fresh + kBrickCells * r, result.changed);
    result.removed_voxels += uint32_t(milled.removed);
    result.added_voxels += uint32_t(milled.added);
}

}  // namespace bonemill
