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

// By `amount` towards the limit if beyond it, never past it.
Density moved(Density old, int limit, int direction, int amount) noexcept {
    if (direction < 0) return old > limit ? Density(std::max(limit, old - amount)) : old;
    return old < limit ? Density(std::min(limit, old + amount)) : old;
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
    changes_.resize(size_t(most.prod()));
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

    collectChanges(volume, p_VB, direction, amount, result);
    if (change_count_ == 0) return result;
    lattice.beginWrite(result.changed);
    for (size_t i = 0; i < change_count_; ++i) volume.set(changes_[i].offset, changes_[i].density);
    lattice.endWrite(result.changed);
    lattice.refreshRanges(volume, result.changed);
    result.shell_is_complete = shell.refresh(volume, lattice, result.changed);
    return result;
}

void TimedMilling::collectChanges(const VoxelVolume& volume, const Eigen::Vector3d& p_VB, int direction,
                                  int amount, MillingResult& result) noexcept {
    change_count_ = 0;
    const BurrLimit limit(volume, burr_radius_, config_.shape, direction);
    const IndexBox box = boxAround(volume, p_VB, limit.reach());
    if (box.isEmpty()) return;
    const double reach_squared = limit.reach() * limit.reach();
    const int finished = direction < 0 ? 0 : kMaxDensity;
    const Density iso = volume.iso();
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j) {
            const double dy = j * volume.spacing().y() - p_VB.y();
            const double dz = k * volume.spacing().z() - p_VB.z();
            const double dyz_squared = dy * dy + dz * dz;
            if (dyz_squared >= reach_squared) continue;
            for (int i = box.min.x(); i <= box.max.x(); ++i) {
                const size_t offset = volume.offset(i, j, k);
                const Density old = volume.ownerData()[offset];
                if (old == finished) continue;  // mostly: air when removing, solid when adding
                const double dx = i * volume.spacing().x() - p_VB.x();
                const double squared = dx * dx + dyz_squared;
                if (squared >= reach_squared) continue;
                const Density now = moved(old, limit.at(squared), direction, amount);
                if (now == old) continue;
                changes_[change_count_++] = {offset, now};
                result.changed.include({i, j, k});
                result.removed_voxels += old >= iso && now < iso;
                result.added_voxels += old < iso && now >= iso;
            }
        }
}

}  // namespace bonemill
