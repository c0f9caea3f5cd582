#include "haptic_server/milling/timed_milling.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

// Voxels of the box around a sphere, writable ones only; empty if the sphere is elsewhere.
IndexBox boxAround(const VoxelVolume& volume, const Eigen::Vector3d& p_VB, double radius) noexcept {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    const Eigen::Array3d low = ((p_VB.array() - radius) / spacing).max(0.0).min(dims);
    const Eigen::Array3d high = ((p_VB.array() + radius) / spacing).max(-1.0).min(dims - 1);
    return {low.ceil().cast<int>().matrix(), high.floor().cast<int>().matrix()};
}

// Voxels of the row at this y and z that have a limit at all; empty if none. m, from the burr's centre.
bool clipToReach(const VoxelVolume& volume, const Eigen::Vector3d& p_VB, double reach_squared, int j, int k,
                 int& low, int& high) noexcept {
    const Eigen::Vector3d& spacing = volume.spacing();
    const double dy = j * spacing.y() - p_VB.y(), dz = k * spacing.z() - p_VB.z();
    const double chord_squared = reach_squared - dy * dy - dz * dz;
    if (chord_squared <= 0) return false;
    // A voxel more at both ends does no harm.
    const double half = std::sqrt(chord_squared);
    low = std::max(low, int(std::max(0.0, (p_VB.x() - half) / spacing.x())));
    high = int(std::min<double>(high, (p_VB.x() + half) / spacing.x() + 1));
    return low <= high;
}

// Nothing is left to do in this leaf.
bool isFinished(const LeafLattice& lattice, LeafId leaf, int direction) noexcept {
    const DensityRange& range = lattice.range(0, leaf);
    return direction < 0 ? range.max == 0 : range.min == kMaxDensity;
}

}  // namespace

TimedMilling::TimedMilling(const MillingConfig& config, const VoxelVolume& volume, double burr_radius)
    : config_(config), burr_radius_(burr_radius) {
    const auto reach = [&](int direction) {
        return BurrLimit(volume, burr_radius, MillingShape::kSubVoxel, direction).reach();
    };
    const double farthest = std::max(reach(-1), reach(+1));
    const Eigen::Array3d voxels = (2 * farthest / volume.spacing().array()).floor() + 2;
    const Eigen::Array3d most = voxels.min(volume.dims().cast<double>().array());
    old_row_.resize(size_t(most.x()) + kRowSlack);
    new_density_.resize(size_t(most.prod()) + kRowSlack);
    runs_.resize(size_t(most.y() * most.z()));
}

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

    collectChanges(volume, lattice, p_VB, direction, amount, result);
    if (run_count_ == 0) return result;
    if (!volume.hasRoomFor(result.changed)) {
        result = {};
        result.has_room = false;
        return result;
    }
    lattice.beginWrite(result.changed);
    for (size_t n = 0; n < run_count_; ++n) {
        const ChangedRun& run = runs_[n];
        volume.writeRow(run.first, run.count, &new_density_[run.first_new]);
    }
    lattice.endWrite(result.changed);
    lattice.refreshRanges(volume, result.changed);
    result.shell_is_complete = shell.refresh(volume, lattice, result.changed);
    return result;
}

void TimedMilling::collectChanges(const VoxelVolume& volume, const LeafLattice& lattice,
                                  const Eigen::Vector3d& p_VB, int direction, int amount,
                                  MillingResult& result) noexcept {
    run_count_ = new_count_ = 0;
    const BurrLimit limit(volume, burr_radius_, config_.shape, direction);
    const double reach_squared = limit.reach() * limit.reach();
    const IndexBox box = boxAround(volume, p_VB, limit.reach());
    if (box.isEmpty()) return;
    const IndexBox leaves = lattice.leavesOfCells(box);  // the voxel is the first corner of its cell
    for (int leaf_z = leaves.min.z(); leaf_z <= leaves.max.z(); ++leaf_z)
        for (int leaf_y = leaves.min.y(); leaf_y <= leaves.max.y(); ++leaf_y) {
            int first = leaves.min.x(), last = leaves.max.x();
            while (first <= last && isFinished(lattice, lattice.leafId({first, leaf_y, leaf_z}), direction))
                ++first;
            while (first <= last && isFinished(lattice, lattice.leafId({last, leaf_y, leaf_z}), direction))
                --last;
            if (first > last) continue;
            const IndexBox voxels = IndexBox{lattice.cellsOf(lattice.leafId({first, leaf_y, leaf_z})).min,
                                             lattice.cellsOf(lattice.leafId({last, leaf_y, leaf_z})).max}
                                        .clamped(box.min, box.max);
            for (int k = voxels.min.z(); k <= voxels.max.z(); ++k)
                for (int j = voxels.min.y(); j <= voxels.max.y(); ++j) {
                    int low = voxels.min.x(), high = voxels.max.x();
                    if (!clipToReach(volume, p_VB, reach_squared, j, k, low, high)) continue;
                    const Eigen::Vector3i start(low, j, k);
                    const Eigen::Vector3d to_start =
                        volume.spacing().cwiseProduct(start.cast<double>()) - p_VB;
                    collectRow(volume, start, high - low + 1,
                               limit.row(to_start, volume.spacing().x(), amount), direction, result);
                }
        }
}

void TimedMilling::collectRow(const VoxelVolume& volume, const Eigen::Vector3i& first, int count,
                              const BurrRow& burr, int direction, MillingResult& result) noexcept {
    const Density* old = old_row_.data();
    volume.readRow(first, count, old_row_.data());
    Density* fresh = new_density_.data() + new_count_;
    const auto mill = direction < 0 ? kernels().remove_row : kernels().add_row;
    const MilledRow milled = mill(burr, old, count, fresh);
    if (milled.changed == 0) return;
    int low = 0, high = count - 1;
    while (old[low] == fresh[low]) ++low;
    while (old[high] == fresh[high]) --high;
    runs_[run_count_++] = {first + Eigen::Vector3i(low, 0, 0), new_count_ + size_t(low), high - low + 1};
    new_count_ += size_t(high) + 1;
    result.changed.include(first + Eigen::Vector3i(low, 0, 0));
    result.changed.include(first + Eigen::Vector3i(high, 0, 0));
    result.removed_voxels += uint32_t(milled.removed);
    result.added_voxels += uint32_t(milled.added);
}

}  // namespace bonemill
