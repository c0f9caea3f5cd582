#include "haptic_server/core/milling/surface_shift.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

// Slopes flatter than this share of that of a ramp from air, or from full density, to the iso-value in one
// voxel count as this, so that a surface on a plateau moves on.
constexpr double kMinSlope = 0.02;
constexpr double kGoldenRatio = 0.6180339887498949;  // spreads the roundings evenly
constexpr int kUnclampedRounds = 3;                  // of corners that come to rest at zero

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

// All corners of a cell must fall by this, so that the density at `t` falls by `excess`. Those that come to
// rest at zero leave the rest to the others.
float equalDrop(const CellCorners& corners, float iso, const Vector3f& t, float excess) noexcept {
    float drop = excess;
    for (int round = 0; round < kUnclampedRounds; ++round) {
        float done = 0, share = 0;
        for (int c = 0; c < 8; ++c) {
            const float weight =
                (c & 1 ? t.x() : 1 - t.x()) * (c & 2 ? t.y() : 1 - t.y()) * (c & 4 ? t.z() : 1 - t.z());
            const float density = corners.excess[size_t(c)] + iso;
            if (density < drop)
                done += weight * density;
            else
                share += weight;
        }
        if (!(share > 0)) break;
        drop = (excess - done) / share;
    }
    return std::clamp(drop, 0.0f, float(kMaxDensity));
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
      nodes_(size_t(size_.cast<int64_t>().prod())),
      row_words_((size_.x() + kRowBits - 1) / kRowBits),
      asked_(size_t(row_words_) * size_t(size_.y()) * size_t(size_.z())),
      patches_(most_contacts),
      near_(nodes_.size()),
      old_(size_t(size_.x() + VoxelVolume::kReadSlack)),
      fresh_(size_t(size_.x())),
      collector_(bone.lattice, size_, most_cells) {}

int SurfaceShift::blockOf(const BoneModel& bone) noexcept {
    return bone.shell.scalingFactor(bone.shell.followed());
}

void SurfaceShift::begin(const BoneModel& bone, const Vector3d& p_VB) noexcept {
    forget();
    const Eigen::Array3d middle = p_VB.array() / bone.volume.spacing().array();
    const Eigen::Array3d last = (bone.volume.dims().array() + 1 - size_.array()).cast<double>();
    first_ = (middle - size_.cast<double>().array() / 2).max(-1.0).min(last).floor().cast<int>().matrix();
    rounding_ += kGoldenRatio;
    rounding_ -= std::floor(rounding_);
}

void SurfaceShift::forget() noexcept {
    for (size_t n = 0; n < patch_count_; ++n) nodes_[patches_[n]].energy = nodes_[patches_[n]].depth = 0;
    patch_count_ = 0;
    last_node_ = kNoNode;
    patch_cells_ = {};
    if (touched_.isEmpty()) return;
    for (int k = touched_.min.z(); k <= touched_.max.z(); ++k)
        for (int j = touched_.min.y(); j <= touched_.max.y(); ++j) {
            const size_t first_word = row(j, k), in_row = index({first_.x(), j, k});
            for (int word = 0; word < row_words_; ++word)
                forEachBit(word, std::exchange(asked_[first_word + size_t(word)], 0), [&](int i) {
                    Node& node = nodes_[in_row + size_t(i)];
                    node.drop = node.weight = 0;
                });
        }
    touched_ = {};
}

bool SurfaceShift::isInScratch(const Vector3i& voxel) const noexcept {
    const Vector3i local = voxel - first_;
    return (local.array() >= 0).all() && (local.array() < size_.array()).all();
}

void SurfaceShift::add(const BoneModel& bone, PatchId patch, double energy, double depth) noexcept {
    if (last_node_ == kNoNode || patch != last_patch_) {
        const Vector3i cell = bone.lattice.cellsOf(patch.leaf).min + patch.block.index() * blockOf(bone);
        if (!isInScratch(cell)) return;
        const size_t at = index(cell);
        if (nodes_[at].depth == 0) {
            if (patch_count_ == patches_.size()) return;
            patches_[patch_count_++] = at;
        }
        patch_cells_.include(cell);
        last_patch_ = patch;
        last_node_ = at;
    }
    Node& node = nodes_[last_node_];
    node.energy += float(energy);
    node.depth = std::max(node.depth, float(depth));
}

// Lists the shell's points around those with energy.
void SurfaceShift::findPatches(const BoneModel& bone) noexcept {
    near_count_ = 0;
    const int factor = blockOf(bone);
    const IndexBox cells = patch_cells_.grown(2 * factor);
    const IndexBox reachable{cells.min.cwiseMax(first_),
                             cells.max.cwiseMin(first_ + size_ - Vector3i::Ones())};
    const auto has_surface = [iso = bone.volume.iso()](const DensityRange& range, const IndexBox&) {
        return range.holds(iso);
    };
    bone.lattice.forEachLeaf(cells, has_surface, [&](LeafId leaf) {
        const Vector3i first = bone.lattice.cellsOf(leaf).min;
        bone.shell.forEachBlock(bone.shell.followed(), leaf, [&](const ShellBlock& b, uint32_t count) {
            for (uint32_t n = 0; n < count && near_count_ < near_.size(); ++n) {
                const Vector3i cell = first + b.key[n].index() * factor;
                const bool is_near = (cell.array() >= reachable.min.array()).all() &&
                                     (cell.array() <= reachable.max.array()).all();
                if (is_near)
                    near_[near_count_++] = {Vector3f(b.x[n], b.y[n], b.z[n]), b.area[n],
                                            uint32_t(index(cell))};
            }
        });
    });
}

// Returns those that can be written where the hat around `at`, in voxel steps, is > 0.
IndexBox SurfaceShift::voxelsAround(const BoneModel& bone, const Vector3f& at) const noexcept {
    const Vector3f width = Vector3f::Constant(float(blockOf(bone)));
    const Vector3i room_low = first_.array() + 1, room_high = (first_ + size_).array() - 2;
    const Vector3i low = floorIndices(at - width).array() + 1, high = ceilIndices(at + width).array() - 1;
    return {low.cwiseMax(room_low).cwiseMax(Vector3i::Zero()),
            high.cwiseMin(room_high).cwiseMin((bone.volume.dims().array() - 1).matrix())};
}

// Calls visit(voxel, weight) with the hat's weights, for voxelsAround(at).
template <class Visit>
void SurfaceShift::forEachVoxelIn(const BoneModel& bone, const IndexBox& voxels, const Vector3f& at,
                                  Visit&& visit) const noexcept {
    const auto width = float(blockOf(bone));
    const auto hat = [&](int voxel, float place) { return width - std::abs(float(voxel) - place); };
    for (int k = voxels.min.z(); k <= voxels.max.z(); ++k)
        for (int j = voxels.min.y(); j <= voxels.max.y(); ++j) {
            const float off_row = hat(k, at.z()) * hat(j, at.y());
            for (int i = voxels.min.x(); i <= voxels.max.x(); ++i)
                visit(Vector3i(i, j, k), off_row * hat(i, at.x()));
        }
}

SurfaceShift::Wish SurfaceShift::wishOf(const VoxelVolume& volume, const Vector3f& point,
                                        double recession) const noexcept {
    const Vector3f inverse = volume.spacing().cwiseInverse().cast<float>();
    const Vector3i last = volume.dims().array() - 1;
    const auto cellAt = [&](const Vector3f& at) -> Vector3i {
        return floorIndices(at).cwiseMax(-1).cwiseMin(last);
    };
    const Vector3f at = point.cwiseProduct(inverse);
    const Vector3i cell = cellAt(at);
    const FieldSample here = sampleField(readCorners(volume, cell), at - cell.cast<float>());
    const Vector3f inward = here.slope.cwiseProduct(inverse);
    const float slope = inward.norm();
    Vector3f target = at;
    if (slope > 0) target += float(recession) / slope * inward.cwiseProduct(inverse);
    const Vector3i target_cell = cellAt(target);
    const Vector3f t = target - target_cell.cast<float>();
    const CellCorners corners = readCorners(volume, target_cell);
    const int to_iso = std::min(int(volume.iso()), kMaxDensity - volume.iso());
    const double least = kMinSlope * to_iso / volume.spacing().maxCoeff() * recession;
    // The point itself is on the surface but for its projection's tolerance.
    const float excess = std::max(sampleField(corners, t).excess - here.excess, float(least));
    return {target, equalDrop(corners, float(volume.iso()), t, excess)};
}

void SurfaceShift::touch(const Vector3i& voxel) noexcept {
    const int i = voxel.x() - first_.x();
    asked_[row(voxel.y(), voxel.z()) + size_t(i / kRowBits)] |= RowBits(1) << (i % kRowBits);
    touched_.include(voxel);
}

// Nothing is asked of this voxel any more.
void SurfaceShift::forgetVoxel(const Vector3i& voxel) noexcept {
    const int i = voxel.x() - first_.x();
    asked_[row(voxel.y(), voxel.z()) + size_t(i / kRowBits)] &= ~(RowBits(1) << (i % kRowBits));
    Node& node = nodes_[index(voxel)];
    node.drop = node.weight = 0;
}

bool SurfaceShift::isAnyTouched(const IndexBox& voxels) const noexcept {
    const IndexBox box = voxels.clamped(touched_.min, touched_.max);
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j) {
            const Span span = touchedIn(row(j, k), box.min.x(), box.max.x());
            if (span.low <= span.high) return true;
        }
    return false;
}

// The span reaches from the first to the last of the row's touched voxels within low .. high.
SurfaceShift::Span SurfaceShift::touchedIn(size_t row, int low, int high) const noexcept {
    const auto isTouched = [&](int voxel) {
        const int i = voxel - first_.x();
        return (asked_[row + size_t(i / kRowBits)] >> (i % kRowBits) & 1) != 0;
    };
    while (low <= high && !isTouched(low)) ++low;
    while (low <= high && !isTouched(high)) --high;
    return {low, high};
}

void SurfaceShift::spreadWishes(const BoneModel& bone, const SpecificEnergy& u, double share,
                                double most) noexcept {
    const Vector3f inverse = bone.volume.spacing().cwiseInverse().cast<float>();
    for (const NearPatch& patch : std::span(near_).first(near_count_)) {
        const Node& node = nodes_[patch.node];
        if (!(node.energy > 0)) continue;
        const float area = patch.area;
        const Vector3i cell = floorIndices(patch.at.cwiseProduct(inverse));
        const double wanted = share * double(node.energy) / (u.ofCell(cell) * double(area));
        is_too_fast_ |= wanted > most;
        const Wish wish = wishOf(bone.volume, patch.at, std::min({wanted, double(node.depth), most}));
        forEachVoxelIn(bone, voxelsAround(bone, wish.at), wish.at, [&](const Vector3i& voxel, float hat) {
            touch(voxel);
            Node& to = nodes_[index(voxel)];
            to.drop += hat * area * wish.drop;
            to.weight += hat * area;
        });
    }
}

// The surface that is to stay has its say, where the other one has.
void SurfaceShift::spreadRest(const BoneModel& bone) noexcept {
    const Vector3f inverse = bone.volume.spacing().cwiseInverse().cast<float>();
    for (const NearPatch& patch : std::span(near_).first(near_count_)) {
        if (nodes_[patch.node].energy > 0) continue;
        const Vector3f at = patch.at.cwiseProduct(inverse);
        const IndexBox voxels = voxelsAround(bone, at);
        if (!isAnyTouched(voxels)) continue;
        forEachVoxelIn(bone, voxels, at, [&](const Vector3i& voxel, float hat) {
            Node& to = nodes_[index(voxel)];
            if (to.weight > 0) to.weight += hat * patch.area;
        });
    }
}

// Calls visit(cell, node) for the cells that have a touched voxel.
template <class Visit>
void SurfaceShift::forEachCell(const BoneModel& bone, Visit&& visit) noexcept {
    const Vector3i last = bone.volume.dims().array() - 1;
    for (int k = touched_.min.z() - 1; k <= std::min(touched_.max.z(), last.z()); ++k)
        for (int j = touched_.min.y() - 1; j <= std::min(touched_.max.y(), last.y()); ++j) {
            const size_t in_row = index({first_.x(), j, k});
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
                    if (first_.x() + i <= last.x())
                        visit(Vector3i(first_.x() + i, j, k), nodes_[in_row + size_t(i)]);
                });
                bits = next;
            }
        }
}

// The same, with the share of the cell that is bone: visit(cell, node, share).
template <class Visit>
void SurfaceShift::forEachFill(const BoneModel& bone, Visit&& visit) noexcept {
    Vector3i cells[CellFills::kMost];
    Node* nodes[CellFills::kMost];
    const auto takeAll = [&] { fills_.take([&](int n, float fill) { visit(cells[n], *nodes[n], fill); }); };
    forEachCell(bone, [&](const Vector3i& cell, Node& node) {
        cells[fills_.count()] = cell, nodes[fills_.count()] = &node;
        fills_.add(readCorners(bone.volume, cell));
        if (fills_.isFull()) takeAll();
    });
    takeAll();
}

double SurfaceShift::apply(BoneModel& bone, const SpecificEnergy& u, double share, size_t ticks,
                           MillingResult& result) noexcept {
    if (patch_count_ == 0 || !(share > 0)) return 0;
    is_too_fast_ = false;
    findPatches(bone);
    spreadWishes(bone, u, share, kMaxShift * double(ticks) * bone.volume.spacing().minCoeff());
    result.is_cut_short |= is_too_fast_;
    if (touched_.isEmpty()) return 0;
    spreadRest(bone);
    collect(bone, result);
    if (collector_.isEmpty()) return 0;
    forEachFill(bone, [](const Vector3i&, Node& node, float fill) { node.fill = fill; });
    result.shell_is_complete &= collector_.write(bone.volume, bone.lattice, bone.shell, -1);
    double spent = 0;
    forEachFill(bone, [&](const Vector3i& cell, const Node& node, float fill) {
        if (const double gone = double(node.fill) - double(fill); gone != 0) spent += u.ofCell(cell) * gone;
    });
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
    const Node* node = &nodes_[index(first)];
    bool is_changed = false;
    for (int i = 0; i < count; ++i) {
        const Density old = old_[size_t(i)];
        Density& fresh = fresh_[size_t(i)] = old;
        if (node[i].drop > 0) {
            const double left = double(old) - double(node[i].drop) / double(node[i].weight);
            fresh = std::min(old, Density(std::floor(std::max(left, 0.0) + rounding_)));
        }
        if (fresh == old) forgetVoxel(first + Vector3i(i, 0, 0));
        is_changed |= fresh < old;
        of_part.removed_voxels += old >= volume.iso() && fresh < volume.iso();
    }
    if (is_changed) rows.add(first, count, old_.data(), fresh_.data(), of_part.changed);
}

}  // namespace bonemill
