#include "haptic_server/core/milling/surface_shift.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kGoldenRatio = 0.6180339887498949;  // spreads the roundings evenly

int coarsestFactor(const PointShell& shell) noexcept {
    int factor = 1;
    for (int level = 0; level < shell.levelCount(); ++level)
        factor = std::max(factor, shell.scalingFactor(level));
    return factor;
}

// Beyond the burr there is room for a block, its kernel and the cells around.
int paddingOf(int factor) noexcept {
    return 2 * factor + 2;
}

Vector3i scratchSize(const BoneModel& bone, double reach) noexcept {
    const int padding = paddingOf(coarsestFactor(bone.shell));
    const Eigen::Array3d voxels = (2 * reach / bone.volume.spacing().array()).ceil() + 2 * padding + 1;
    return voxels.min((bone.volume.dims().array() + 2).cast<double>()).cast<int>().matrix();
}

// These are the bits of a word of such a row that stand for low .. high, which it has some of.
uint64_t bitsIn(int word, int low, int high) noexcept {
    const int first = std::max(low - word * 64, 0), last = std::min(high - word * 64, 63);
    return (~uint64_t(0) >> (63 - last)) & (~uint64_t(0) << first);
}

// Calls visit(voxels from the scratch box on) for the bits of this word of a row of SurfaceShift.
template <class Visit>
void forEachBit(int word, uint64_t bits, Visit&& visit) noexcept {
    for (; bits != 0; bits &= bits - 1) visit(word * int(8 * sizeof bits) + std::countr_zero(bits));
}

}  // namespace

SurfaceShift::SurfaceShift(const BoneModel& bone, double largest_reach, size_t most_contacts,
                           size_t most_cells)
    : size_(scratchSize(bone, largest_reach)),
      orders_(size_t(size_.cast<int64_t>().prod())),
      drops_(orders_.size() + kCellLanes),
      weights_(drops_.size()),
      row_words_((size_.x() + kRowBits - 1) / kRowBits),
      asked_(size_t(row_words_) * size_t(size_.y()) * size_t(size_.z())),
      patches_(most_contacts),
      near_(orders_.size()),
      cells_(orders_.size()),
      fills_before_(orders_.size() + kCellLanes),
      fills_after_(fills_before_.size()),
      inside_(fills_before_.size()),
      unknown_(orders_.size()),
      unknown_at_(orders_.size()),
      old_(size_t(size_.x() + VoxelVolume::kReadSlack)),
      fresh_(size_t(size_.x())),
      collector_(bone.lattice, size_, most_cells) {}

void SurfaceShift::begin(const BoneModel& bone, const Burr& burr, const Pose& X_VT) noexcept {
    forget();
    burr_ = burr;
    X_VT_ = X_VT;
    const Eigen::Array3d middle = X_VT.position.array() / bone.volume.spacing().array();
    const Eigen::Array3d last = (bone.volume.dims().array() + 1 - size_.array()).cast<double>();
    first_ = (middle - size_.cast<double>().array() / 2).max(-1.0).min(last).floor().cast<int>().matrix();
    room_ = {(first_.array() + 1).max(0), (first_ + size_).array() - 2};
    room_.max = room_.max.cwiseMin((bone.volume.dims().array() - 1).matrix());
    block_ = bone.shell.scalingFactor(bone.shell.followed());
    rounding_ += kGoldenRatio;
    rounding_ -= std::floor(rounding_);
}

void SurfaceShift::forget() noexcept {
    for (size_t n = 0; n < patch_count_; ++n) orders_[patches_[n]] = {};
    patch_count_ = 0;
    last_node_ = kNoNode;
    patch_cells_ = {};
    if (touched_.isEmpty()) return;
    for (int k = touched_.min.z(); k <= touched_.max.z(); ++k)
        for (int j = touched_.min.y(); j <= touched_.max.y(); ++j) {
            const size_t first_word = row(j, k), in_row = index({first_.x(), j, k});
            for (int word = 0; word < row_words_; ++word)
                forEachBit(word, std::exchange(asked_[first_word + size_t(word)], 0),
                           [&](int i) { drops_[in_row + size_t(i)] = weights_[in_row + size_t(i)] = 0; });
        }
    touched_ = {};
}

bool SurfaceShift::isInScratch(const Vector3i& voxel) const noexcept {
    const Vector3i local = voxel - first_;
    return (local.array() >= 0).all() && (local.array() < size_.array()).all();
}

void SurfaceShift::add(const BoneModel& bone, PatchId patch, double energy, double depth) noexcept {
    if (last_node_ == kNoNode || patch != last_patch_) {
        if (patch.leaf != leaf_) leaf_first_ = bone.lattice.cellsOf(leaf_ = patch.leaf).min;
        const Vector3i cell = leaf_first_ + patch.block.index() * block_;
        if (!isInScratch(cell)) return;
        const size_t at = index(cell);
        if (orders_[at].depth == 0) {
            if (patch_count_ == patches_.size()) return;
            patches_[patch_count_++] = at;
        }
        patch_cells_.include(cell);
        last_patch_ = patch;
        last_node_ = at;
    }
    Order& order = orders_[last_node_];
    order.energy += float(energy);
    order.depth = std::max(order.depth, float(depth));
}

void SurfaceShift::findBoxes(Hats& hats, int count) const noexcept {
    HatBoxes boxes{{hats.x, hats.y, hats.z}, float(block_), {}, {}, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        boxes.low[axis] = room_.min[axis], boxes.high[axis] = room_.max[axis];
        boxes.first[axis] = hats.first[axis], boxes.count[axis] = hats.count[axis];
    }
    kernels().hat_boxes(boxes, count);
}

// It has the voxels that can be written; none on any axis, none at all.
VoxelHat SurfaceShift::hatOf(const Hats& hats, int n) const noexcept {
    VoxelHat hat{.at = {hats.x[n], hats.y[n], hats.z[n]},
                 .width = float(block_),
                 .first = {hats.first[0][n], hats.first[1][n], hats.first[2][n]},
                 .count = {hats.count[0][n], hats.count[1][n], hats.count[2][n]},
                 .stride_y = size_t(size_.x()),
                 .stride_z = size_t(size_.x()) * size_t(size_.y())};
    if (std::min({hat.count[0], hat.count[1], hat.count[2]}) <= 0)
        hat.count[0] = hat.count[1] = hat.count[2] = 0;
    return hat;
}

// Calls visit(its word of asked_, its bits) for the rows of a hat, until that returns true; returns whether
// it did.
template <class Visit>
bool SurfaceShift::forEachRow(const VoxelHat& hat, Visit&& visit) const noexcept {
    const int low = hat.first[0] - first_.x(), high = low + hat.count[0] - 1;
    for (int k = 0; k < hat.count[2]; ++k)
        for (int j = 0; j < hat.count[1]; ++j) {
            const size_t first_word = row(hat.first[1] + j, hat.first[2] + k);
            for (int word = low / kRowBits; word <= high / kRowBits; ++word)
                if (visit(first_word + size_t(word), bitsIn(word, low, high))) return true;
        }
    return false;
}

void SurfaceShift::touch(const VoxelHat& hat) noexcept {
    forEachRow(hat, [&](size_t word, RowBits bits) {
        asked_[word] |= bits;
        return false;
    });
    const Vector3i first(hat.first[0], hat.first[1], hat.first[2]);
    touched_.include(first);
    touched_.include(first + Vector3i(hat.count[0] - 1, hat.count[1] - 1, hat.count[2] - 1));
}

bool SurfaceShift::isAnyTouched(const VoxelHat& hat) const noexcept {
    return forEachRow(hat, [&](size_t word, RowBits bits) { return (asked_[word] & bits) != 0; });
}

// Nothing is asked of this voxel any more.
void SurfaceShift::forgetVoxel(const Vector3i& voxel) noexcept {
    const int i = voxel.x() - first_.x();
    asked_[row(voxel.y(), voxel.z()) + size_t(i / kRowBits)] &= ~(RowBits(1) << (i % kRowBits));
    drops_[index(voxel)] = weights_[index(voxel)] = 0;
}

// The span reaches from the first to the last of the row's touched voxels within low .. high.
SurfaceShift::Span SurfaceShift::touchedIn(size_t row, int low, int high) const noexcept {
    const int low_bit = low - first_.x(), high_bit = high - first_.x();
    Span span;
    for (int word = low_bit / kRowBits; word <= high_bit / kRowBits; ++word) {
        const RowBits bits = asked_[row + size_t(word)] & bitsIn(word, low_bit, high_bit);
        if (bits == 0) continue;
        const int first = first_.x() + word * kRowBits;
        if (span.low > span.high) span.low = first + std::countr_zero(bits);
        span.high = first + kRowBits - 1 - std::countl_zero(bits);
    }
    return span;
}

// Of the bone inside the burr, which is little: as much as the burr is pressed in.
void SurfaceShift::leaveOutRestInsideBurr(const VoxelVolume& volume) noexcept {
    const double reach = burr_.reach();
    const Vector3d step = volume.spacing(), middle = X_VT_.position;
    const Pose X_TV = X_VT_.inverse();
    for (int k = touched_.min.z(); k <= touched_.max.z(); ++k)
        for (int j = touched_.min.y(); j <= touched_.max.y(); ++j) {
            const double y = step.y() * j, z = step.z() * k;
            const double beside =
                reach * reach - (y - middle.y()) * (y - middle.y()) - (z - middle.z()) * (z - middle.z());
            if (!(beside > 0)) continue;
            const size_t first_word = row(j, k);
            for (int word = 0; word < row_words_; ++word)
                forEachBit(word, asked_[first_word + size_t(word)], [&](int i) {
                    const double x = step.x() * (first_.x() + i);
                    if ((x - middle.x()) * (x - middle.x()) >= beside) return;
                    if (volume.at(first_.x() + i, j, k) < volume.iso()) return;
                    float& weight = weights_[index({first_.x() + i, j, k})];
                    if (burr_.signedDistance(X_TV * Vector3d(x, y, z)) < 0) weight = -weight;
                });
        }
}

// Calls visit(cell) for the cells that have a touched voxel.
template <class Visit>
void SurfaceShift::forEachCell(const VoxelVolume& volume, Visit&& visit) const noexcept {
    const Vector3i last = volume.dims().array() - 1;
    for (int k = touched_.min.z() - 1; k <= std::min(touched_.max.z(), last.z()); ++k)
        for (int j = touched_.min.y() - 1; j <= std::min(touched_.max.y(), last.y()); ++j) {
            const size_t rows[4] = {row(j, k), row(j + 1, k), row(j, k + 1), row(j + 1, k + 1)};
            const auto voxels = [&](int word) {
                RowBits bits = 0;
                for (const size_t row : rows) bits |= asked_[row + size_t(word)];
                return bits;
            };
            RowBits bits = voxels(0);
            for (int word = 0; word < row_words_; ++word) {
                const RowBits next = word + 1 < row_words_ ? voxels(word + 1) : 0;
                // A cell has its own voxel and the next one.
                const RowBits cells = bits | bits >> 1 | next << (kRowBits - 1);
                forEachBit(word, cells, [&](int i) {
                    if (first_.x() + i <= last.x()) visit(Vector3i(first_.x() + i, j, k));
                });
                bits = next;
            }
        }
}

// Lists the cells that may lose bone, and measures how much they have.
void SurfaceShift::findCells(const VoxelVolume& volume) noexcept {
    cells_.clear(), unknown_.clear();
    forEachCell(volume, [&](const Vector3i& cell) {
        const CellBone* known = known_bone_.find(cell);
        if (known && !known->at_corners) return;
        if (known) {
            fills_before_[cells_.count()] = known->fill;
        } else {
            unknown_at_[unknown_.count()] = cells_.count();
            unknown_.add(cell);
        }
        cells_.add(cell);
    });
    // fills_after_ and inside_ are free until measureAgain().
    fills_.measure(volume, unknown_.list(), fills_after_.data(), inside_.data());
    for (size_t n = 0; n < unknown_.count(); ++n) fills_before_[unknown_at_[n]] = fills_after_[n];
}

void SurfaceShift::measureAgain(const VoxelVolume& volume) noexcept {
    fills_.measure(volume, cells_.list(), fills_after_.data(), inside_.data());
    for (size_t n = 0; n < cells_.count(); ++n)
        known_bone_.remember(cells_[n], {fills_after_[n], inside_[n] != 0});
}

double SurfaceShift::apply(BoneModel& bone, SpecificEnergy& u, double share, size_t ticks,
                           MillingResult& result) noexcept {
    if (patch_count_ == 0 || !(share > 0)) return 0;
    is_too_fast_ = false;
    findPatches(bone);
    spreadWishes(bone, u, share, kMaxShift * double(ticks) * bone.volume.spacing().minCoeff());
    result.is_cut_short |= is_too_fast_;
    if (touched_.isEmpty()) return 0;
    if (ticks == 1) leaveOutRestInsideBurr(bone.volume);  // else it also is surface whose turn comes later
    spreadRest(bone);
    collect(bone, result);
    if (collector_.isEmpty()) return 0;
    if (bone.lattice.writeCount() != known_at_write_) known_bone_.forgetAll();
    findCells(bone.volume);
    result.shell_is_complete &= collector_.write(bone.volume, bone.lattice, bone.shell, -1);
    measureAgain(bone.volume);
    known_at_write_ = bone.lattice.writeCount();
    double spent = 0;
    for (size_t n = 0; n < cells_.count(); ++n)
        if (const double gone = double(fills_before_[n]) - double(fills_after_[n]); gone != 0)
            spent += u.ofCell(cells_[n]) * gone;
    return spent * bone.volume.voxelVolume();
}

void SurfaceShift::collect(BoneModel& bone, MillingResult& result) noexcept {
    const auto is_wanted = [](const DensityRange& range, const IndexBox&) { return range.max > 0; };
    collector_.collect(
        bone.lattice, touched_, is_wanted,
        [&](const IndexBox& voxels, int, MillingResult& of_leaf) {
            return collectLeaf(bone.volume, voxels, of_leaf) ? ChangeCollector::kAllParts : 0;
        },
        result);
}

// The whole leaf is one part. Returns what ChangeCollector::takePart() says.
bool SurfaceShift::collectLeaf(VoxelVolume& volume, const IndexBox& voxels, MillingResult& of_leaf) noexcept {
    ChangedRuns& rows = collector_.beginPart();
    MillingResult of_part;
    for (int k = voxels.min.z(); k <= voxels.max.z(); ++k)
        for (int j = voxels.min.y(); j <= voxels.max.y(); ++j) {
            const Span span = touchedIn(row(j, k), voxels.min.x(), voxels.max.x());
            if (span.low <= span.high)
                collectRow(volume, {span.low, j, k}, span.high - span.low + 1, rows, of_part);
        }
    return of_part.changed.isEmpty() || collector_.takePart(volume, 0, of_part, of_leaf);
}

// Forgets the voxels that stay as they are, so that the cells around them are not looked at.
void SurfaceShift::collectRow(const VoxelVolume& volume, const Vector3i& first, int count, ChangedRuns& rows,
                              MillingResult& of_part) noexcept {
    volume.readRow(first, count, old_.data());
    const float *drop = &drops_[index(first)], *weight = &weights_[index(first)];
    bool is_changed = false;
    for (int i = 0; i < count; ++i) {
        const Density old = old_[size_t(i)];
        Density& fresh = fresh_[size_t(i)] = old;
        if (drop[i] > 0) {
            const double left = double(old) - double(drop[i]) / std::abs(double(weight[i]));
            fresh = std::min(old, Density(std::floor(std::max(left, 0.0) + rounding_)));
        }
        if (fresh == old) forgetVoxel(first + Vector3i(i, 0, 0));
        is_changed |= fresh < old;
        of_part.removed_voxels += old >= volume.iso() && fresh < volume.iso();
    }
    if (is_changed) rows.add(first, count, old_.data(), fresh_.data(), of_part.changed);
}

}  // namespace bonemill
