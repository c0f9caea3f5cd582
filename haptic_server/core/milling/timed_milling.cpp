#include "haptic_server/core/milling/timed_milling.h"

#include <cmath>

#include "haptic_server/core/milling/burr_limit.h"

namespace bonemill {
namespace {

constexpr int64_t kCellsLookedAtPerWorkedOn = 8;  // so much quicker

// How many voxels per axis a burr of this radius can change.
Eigen::Vector3i mostVoxels(const VoxelVolume& volume, double burr_radius, double longest_way) noexcept {
    const auto reach = [&](int direction) {
        return BurrLimit(volume, burr_radius, MillingShape::kSubVoxel, direction).reach();
    };
    const double farthest = std::max(reach(-1), reach(+1));
    const Eigen::Array3d voxels = ((2 * farthest + longest_way) / volume.spacing().array()).floor() + 2;
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
      collector_(lattice, mostVoxels(volume, largest_burr_radius, config.longest_way), config.most_cells) {}

bool TimedMilling::Stroke::isOutOfReach(const VoxelVolume& volume, const IndexBox& voxels) const noexcept {
    const double reach = limit.reach() + way.length() / 2;
    return squaredDistance(volume, voxels, way.middle()) >= reach * reach;
}

double TimedMilling::countsOf(double rate, const BurrLimit& limit, double dt) const noexcept {
    const bool is_each_voxel = config_.shape == MillingShape::kVoxelCentres;
    return dt * (is_each_voxel ? rate : speedAt(rate) * limit.slope());
}

MillingResult TimedMilling::apply(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell,
                                  const BurrWay& way, int direction, double dt) noexcept {
    MillingResult result;
    if (direction == 0) return result;
    if (direction != carry_direction_) carry_ = 0;
    carry_direction_ = direction;
    const BurrLimit limit(volume, burr_radius_, config_.shape, direction);
    carry_ += countsOf(direction < 0 ? config_.removal_rate : config_.addition_rate, limit, dt);
    const int amount = int(std::min(carry_, double(kMaxDensity)));
    if (amount == 0) return result;

    collectChanges(volume, lattice, {seenWay(volume, way, burr_radius_), direction, amount, limit}, result);
    if (!result.is_cut_short) carry_ -= std::floor(carry_);
    if (!collector_.isEmpty()) result.shell_is_complete = collector_.write(volume, lattice, shell, direction);
    return result;
}

void TimedMilling::collectChanges(VoxelVolume& volume, const LeafLattice& lattice, const Stroke& stroke,
                                  MillingResult& result) noexcept {
    const auto is_wanted = [&](const DensityRange& range, const IndexBox& voxels) {
        return !isFinished(range, stroke.direction) && !stroke.isOutOfReach(volume, voxels);
    };
    collector_.collect(
        lattice, boxAround(volume, stroke.way, Eigen::Array3d::Constant(stroke.limit.reach())), is_wanted,
        [&](const IndexBox& voxels, int first_part, MillingResult& of_leaf) {
            return ChangeCollector::collectBricks(
                volume, voxels, first_part, [&](const IndexBox& part, size_t offset) {
                    return collectPart(volume, part, offset, stroke, of_leaf);
                });
        },
        result);
}

// Returns what ChangeCollector::takePart() says.
bool TimedMilling::collectPart(VoxelVolume& volume, const IndexBox& part, size_t offset, const Stroke& stroke,
                               MillingResult& of_leaf) noexcept {
    ChangedRuns& rows = collector_.beginPart();
    MillingResult of_part;
    IndexBox plane = part;
    for (int k = part.min.z(); k <= part.max.z(); ++k, offset += VoxelVolume::kStrideZ) {
        plane.min.z() = plane.max.z() = k;
        if (stroke.isOutOfReach(volume, plane)) continue;
        collectPlane(volume, plane, offset, stroke, rows, of_part);
    }
    return collector_.takePart(volume, size_t(part.count() / kCellsLookedAtPerWorkedOn), of_part, of_leaf);
}

void TimedMilling::collectPlane(const VoxelVolume& volume, const IndexBox& plane, size_t offset,
                                const Stroke& stroke, ChangedRuns& rows, MillingResult& of_part) noexcept {
    const Eigen::Vector3d to_first =
        volume.spacing().cwiseProduct(plane.min.cast<double>()) - stroke.way.from();
    const BurrPlane burr = stroke.limit.plane(stroke.way, to_first, volume.spacing(), stroke.amount);
    const Density* old = volume.ownerData() + offset;
    Density fresh[kBrickCells * kBrickCells];
    const int count = plane.max.x() - plane.min.x() + 1, row_count = plane.max.y() - plane.min.y() + 1;
    const auto mill = stroke.direction < 0 ? kernels().remove_plane : kernels().add_plane;
    const MilledPlane milled = mill(burr, old, count, row_count, fresh);
    for (int r = 0; r < row_count; ++r)
        if (milled.is_changed >> r & 1)
            rows.add(plane.min + Eigen::Vector3i(0, r, 0), count, old + VoxelVolume::kStrideY * size_t(r),
                     fresh + kBrickCells * r, of_part.changed);
    of_part.removed_voxels += uint32_t(milled.removed);
    of_part.added_voxels += uint32_t(milled.added);
}

}  // namespace bonemill
