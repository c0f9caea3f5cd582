#include "haptic_server/core/milling/deposit.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/milling/burr_limit.h"

namespace bonemill {
namespace {

// Beyond the bricks that a burr can reach in a tick there are N more on each side, in which what is
// left behind rises at the rate; in the outermost it comes at once.
constexpr int kBricksAround = 2;
constexpr int64_t kLookedAtPerCell = 8;

// On the mean over the cells the surface then lies on the ball: of what burr_limit.h enlarges the ball by,
// the interpolation takes 3/7 back.
double onTheMean(const VoxelVolume& volume, double burr_radius) noexcept {
    return burr_radius - 4.0 / 7 * BurrLimit::ampleSag(volume, burr_radius);
}

Eigen::Vector3i bricksOf(const VoxelVolume& volume) noexcept {
    return (volume.dims().array() + 1) / kBrickCells + 1;
}

Eigen::Vector3i slotsPerAxis(const VoxelVolume& volume, const DepositConfig& config) noexcept {
    const double reach = BurrLimit(volume, config.largest_burr_radius, MillingShape::kSubVoxel, +1).reach();
    const Eigen::Array3d bricks = (2 * reach + config.longest_way) / (volume.spacing().array() * kBrickCells);
    return (bricks.ceil().cast<int>() + 1 + 2 * kBricksAround).matrix().cwiseMin(bricksOf(volume));
}

}  // namespace

Deposit::Deposit(const BoneModel& bone, const DepositConfig& config)
    : config_(config),
      slots_per_axis_(slotsPerAxis(bone.volume, config)),
      slots_(size_t(slots_per_axis_.prod())),
      shall_(slots_.size() * kBrick),
      before_(slots_.size() * kBrick),
      falling_(bone.lattice, (slots_per_axis_ * kBrickCells).cwiseMin(bone.volume.dims()), config.most_cells),
      collector_(bone.lattice, (slots_per_axis_ * kBrickCells).cwiseMin(bone.volume.dims()),
                 config.most_cells) {}

size_t Deposit::slotOf(const Eigen::Vector3i& brick) const noexcept {
    const Eigen::Vector3i& n = slots_per_axis_;
    return placeIn(n, {brick.x() % n.x(), brick.y() % n.y(), brick.z() % n.z()});
}

size_t Deposit::placeOf(size_t slot, const Eigen::Vector3i& voxel) noexcept {
    const auto in_brick = [](int index) { return size_t((index + 1) & (kBrickCells - 1)); };
    return slot * kBrick + in_brick(voxel.x()) + kBrickStrideY * in_brick(voxel.y()) +
           kPlane * in_brick(voxel.z());
}

void Deposit::clear(size_t slot) noexcept {
    if (slots_[slot].owed.isEmpty()) return;
    std::fill_n(&shall_[slot * kBrick], kBrick, Density(0));
    slots_[slot].owed = {};
    --used_count_;
}

void Deposit::forget() noexcept {
    for (size_t slot = 0; used_count_ > 0; ++slot) clear(slot);
    carry_ = 0;
    falling_.forgetTurn();
    collector_.forgetTurn();
}

size_t Deposit::claim(const Eigen::Vector3i& brick) noexcept {
    const size_t slot = slotOf(brick);
    if (slots_[slot].brick != brick) clear(slot);
    if (slots_[slot].owed.isEmpty()) ++used_count_;
    slots_[slot].brick = brick;
    slots_[slot].is_settled = false;
    return slot;
}

// How many bricks lie around the burr.
IndexBox Deposit::around(const VoxelVolume& volume, const Eigen::Vector3d& p_VB) const noexcept {
    const Eigen::Array3d place = (p_VB.array() / volume.spacing().array() + 1) / kBrickCells;
    const Eigen::Array3d low = (place - slots_per_axis_.cast<double>().array() / 2 + 0.5).floor();
    const Eigen::Vector3i first = low.max(-1e6).min(1e6).cast<int>().matrix();
    return {first, first + slots_per_axis_ - Eigen::Vector3i::Ones()};
}

// These bricks have slots of their own while the burr is here: as many of the volume's as there can be.
IndexBox Deposit::window(const VoxelVolume& volume, const Eigen::Vector3d& p_VB) const noexcept {
    const Eigen::Vector3i last = bricksOf(volume) - slots_per_axis_;
    const Eigen::Vector3i first = around(volume, p_VB).min.cwiseMin(last).cwiseMax(0);
    return {first, first + slots_per_axis_ - Eigen::Vector3i::Ones()};
}

void Deposit::dropOutside(const IndexBox& bricks) noexcept {
    for (size_t slot = 0; slot < slots_.size(); ++slot) {
        const Eigen::Array3i brick = slots_[slot].brick.array();
        if ((brick < bricks.min.array()).any() || (brick > bricks.max.array()).any()) clear(slot);
    }
}

void Deposit::owe(const VoxelVolume& volume, const BurrWay& way, double burr_radius) noexcept {
    if (!(config_.rate > 0)) return;
    const double radius = std::min(burr_radius, config_.largest_burr_radius);
    const BurrLimit limit(volume, onTheMean(volume, radius), MillingShape::kSubVoxel, +1);
    const BurrWay seen = seenWay(volume, way, radius);
    if (used_count_ > 0) dropOutside(window(volume, way.to()));
    volume.forEachOwnedPart(boxAround(volume, seen, Eigen::Array3d::Constant(limit.reach())),
                            [&](const IndexBox& part, size_t) { raise(volume, part, seen, limit); });
}

void Deposit::raise(const VoxelVolume& volume, const IndexBox& part, const BurrWay& way,
                    const BurrLimit& limit) noexcept {
    const size_t slot = claim(brickOf(part.min));
    const int count = part.max.x() - part.min.x() + 1, rows = part.max.y() - part.min.y() + 1;
    Density fresh[kBrickCells * kBrickCells];
    Density* shall = &shall_[placeOf(slot, part.min)];
    Density* before = &before_[placeOf(slot, part.min)];
    const Density* now = volume.ownerData() + volume.offset(part.min.x(), part.min.y(), part.min.z());
    slots_[slot].owed.include(part);
    for (int k = part.min.z(); k <= part.max.z();
         ++k, shall += kPlane, before += kPlane, now += VoxelVolume::kStrideZ) {
        const Eigen::Vector3d to_first =
            volume.spacing().cwiseProduct(Eigen::Vector3d(part.min.x(), part.min.y(), k)) - way.from();
        const BurrPlane burr = limit.plane(way, to_first, volume.spacing(), kMaxDensity);
        const MilledPlane raised = kernels().add_plane(burr, shall, count, rows, fresh);
        for (int r = 0; r < rows; ++r) {
            if (!(raised.is_changed >> r & 1)) continue;
            const size_t row = kBrickStrideY * size_t(r);
            for (int i = 0; i < count; ++i)
                if (shall[row + size_t(i)] == 0)
                    before[row + size_t(i)] = now[VoxelVolume::kStrideY * size_t(r) + size_t(i)];
            std::copy_n(fresh + kBrickCells * r, count, shall + row);
        }
    }
}

MillingResult Deposit::lay(BoneModel& bone, const ToolPlace& place, double dt, bool is_stroke) noexcept {
    MillingResult result;
    if (!isOwing()) return result;
    const VoxelVolume& volume = bone.volume;
    dropOutside(window(volume, place.p_VB));
    carry_ += config_.rate * dt;
    const int amount = int(std::min(carry_, double(kMaxDensity)));
    const double length =
        volume.spacing().cwiseProduct((slots_per_axis_ * kBrickCells).cast<double>()).norm();
    // No cell that the tool reaches into has a corner that rises.
    const double free = place.radius + place.way + volume.spacing().norm();
    const Stroke stroke{BurrWay(place.p_VB + length * place.axis_V, place.p_VB, length),
                        BurrLimit(volume, free, MillingShape::kVoxelCentres, -1), amount,
                        around(volume, place.p_VB).grown(-1)};
    IndexBox owed;
    for (Slot& slot : slots_) {
        slot.is_left = false;
        owed.include(slot.owed);
    }
    if (is_stroke) makeWay(bone, stroke, owed, result);
    const auto is_wanted = [](const DensityRange& range, const IndexBox&) { return range.min < kMaxDensity; };
    collector_.collect(
        bone.lattice, owed, is_wanted,
        [&](const IndexBox& voxels, int first_part, MillingResult& of_leaf) {
            return collectLeaf(bone.volume, voxels, first_part, [&](const IndexBox& part, Slot& slot) {
                return slot.is_settled || raisePart(bone.volume, part, stroke, slot, of_leaf);
            });
        },
        result);
    if (!collector_.isEmpty())
        result.shell_is_complete &= collector_.write(bone.volume, bone.lattice, bone.shell, +1);
    if (result.is_cut_short) return result;
    carry_ -= std::floor(carry_);
    for (size_t slot = 0; slot < slots_.size(); ++slot) {
        slots_[slot].is_settled = !slots_[slot].is_left;
        if (!is_stroke && slots_[slot].is_settled) clear(slot);
    }
    return result;
}

void Deposit::makeWay(BoneModel& bone, const Stroke& stroke, const IndexBox& owed,
                      MillingResult& result) noexcept {
    const auto is_wanted = [](const DensityRange& range, const IndexBox&) { return range.max > 0; };
    falling_.collect(
        bone.lattice, owed, is_wanted,
        [&](const IndexBox& voxels, int first_part, MillingResult& of_leaf) {
            return collectLeaf(bone.volume, voxels, first_part, [&](const IndexBox& part, Slot& slot) {
                return lowerPart(bone.volume, part, stroke, slot, of_leaf);
            });
        },
        result);
    if (!falling_.isEmpty())
        result.shell_is_complete = falling_.write(bone.volume, bone.lattice, bone.shell, -1);
}

template <class CollectPart>
int Deposit::collectLeaf(const VoxelVolume& volume, const IndexBox& voxels, int first_part,
                         CollectPart&& collect_part) noexcept {
    return ChangeCollector::collectBricks(volume, voxels, first_part, [&](const IndexBox& whole, size_t) {
        const Eigen::Vector3i brick = brickOf(whole.min);
        Slot& slot = slots_[slotOf(brick)];
        if (slot.owed.isEmpty() || slot.brick != brick) return true;
        const IndexBox part = whole.clamped(slot.owed.min, slot.owed.max);
        return part.isEmpty() || collect_part(part, slot);
    });
}

BurrPlane Deposit::planeOf(const VoxelVolume& volume, const Eigen::Vector3i& first, const Stroke& stroke,
                           int amount) const noexcept {
    const Eigen::Vector3d to_first =
        volume.spacing().cwiseProduct(first.cast<double>()) - stroke.place.from();
    return stroke.limit.plane(stroke.place, to_first, volume.spacing(), amount);
}

// Returns what ChangeCollector::takePart() says.
bool Deposit::lowerPart(VoxelVolume& volume, const IndexBox& part, const Stroke& stroke, Slot& slot,
                        MillingResult& of_leaf) noexcept {
    const Eigen::Vector3d middle =
        (part.min + part.max).cast<double>().cwiseProduct(volume.spacing()) / 2 - stroke.place.from();
    const double half = ((part.max - part.min).cast<double>().cwiseProduct(volume.spacing())).norm() / 2;
    const double along = std::clamp(middle.dot(stroke.place.direction()), 0.0, stroke.place.length());
    if ((middle - along * stroke.place.direction()).norm() > stroke.limit.reach() + half) return true;
    ChangedRuns& changed_rows = falling_.beginPart();
    MillingResult of_part;
    const int count = part.max.x() - part.min.x() + 1, rows = part.max.y() - part.min.y() + 1;
    const Density* old = volume.ownerData() + volume.offset(part.min.x(), part.min.y(), part.min.z());
    size_t kept = placeOf(size_t(&slot - slots_.data()), part.min);
    Density fresh[kBrickCells * kBrickCells];
    for (int k = part.min.z(); k <= part.max.z(); ++k, old += VoxelVolume::kStrideZ, kept += kPlane) {
        const Eigen::Vector3i first(part.min.x(), part.min.y(), k);
        const MilledPlane free =
            kernels().remove_plane(planeOf(volume, first, stroke, int(kMaxDensity)), old, count, rows, fresh);
        for (int r = 0; r < rows; ++r) {
            if (!(free.is_changed >> r & 1)) continue;
            const Density* row = old + VoxelVolume::kStrideY * size_t(r);
            bool is_changed = false;
            for (int i = 0; i < count; ++i) {
                const size_t at = kept + kBrickStrideY * size_t(r) + size_t(i);
                Density& now = fresh[kBrickCells * r + i];
                if (now != row[i]) now = shall_[at] > 0 ? std::min(row[i], before_[at]) : row[i];
                is_changed |= now != row[i];
                of_part.removed_voxels += row[i] >= volume.iso() && now < volume.iso();
            }
            if (is_changed)
                changed_rows.add(first + Eigen::Vector3i(0, r, 0), count, row, fresh + kBrickCells * r,
                                 of_part.changed);
        }
    }
    slot.is_settled &= of_part.changed.isEmpty();
    return falling_.takePart(volume, size_t(part.count() / kLookedAtPerCell), of_part, of_leaf);
}

// Returns what ChangeCollector::takePart() says.
bool Deposit::raisePart(VoxelVolume& volume, const IndexBox& part, const Stroke& stroke, Slot& slot,
                        MillingResult& of_leaf) noexcept {
    ChangedRuns& changed_rows = collector_.beginPart();
    MillingResult of_part;
    const IndexBox& near = stroke.near;
    const bool is_near =
        (slot.brick.array() >= near.min.array()).all() && (slot.brick.array() <= near.max.array()).all();
    const int count = part.max.x() - part.min.x() + 1, rows = part.max.y() - part.min.y() + 1;
    const Density* old = volume.ownerData() + volume.offset(part.min.x(), part.min.y(), part.min.z());
    const Density* shall = &shall_[placeOf(size_t(&slot - slots_.data()), part.min)];
    Density fresh[kBrickCells * kBrickCells];
    for (int k = part.min.z(); k <= part.max.z(); ++k, old += VoxelVolume::kStrideZ, shall += kPlane) {
        const Eigen::Vector3i first(part.min.x(), part.min.y(), k);
        const BurrPlane place = planeOf(volume, first, stroke, is_near ? stroke.amount : int(kMaxDensity));
        const LaidPlane laid = kernels().lay_plane(place, shall, old, count, rows, fresh);
        slot.is_left |= laid.is_owed;
        for (int r = 0; r < rows; ++r)
            if (laid.is_changed >> r & 1)
                changed_rows.add(first + Eigen::Vector3i(0, r, 0), count,
                                 old + VoxelVolume::kStrideY * size_t(r), fresh + kBrickCells * r,
                                 of_part.changed);
        of_part.added_voxels += uint32_t(laid.added);
    }
    return collector_.takePart(volume, size_t(part.count() / kLookedAtPerCell), of_part, of_leaf);
}

}  // namespace bonemill
