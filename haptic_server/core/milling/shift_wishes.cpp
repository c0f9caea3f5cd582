// What the patches of the shell ask of the voxels around them.
#include <algorithm>
#include <span>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/milling/surface_shift.h"
#include "haptic_server/core/volume/density_view.h"
#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

// Slopes flatter than this share of that of a ramp from air, or from full density, to the iso-value in one
// voxel count as this, so that a surface on a plateau moves on.
constexpr double kMinSlope = 0.02;

// By a divisor > 0, rounded down.
Vector3i floorDivided(const Vector3i& of, int by) noexcept {
    return of.unaryExpr([by](int v) { return v >= 0 ? v / by : -((by - 1 - v) / by); });
}

}  // namespace

// Lists the shell's points around those with energy.
void SurfaceShift::findPatches(const BoneModel& bone) noexcept {
    near_count_ = 0;
    const IndexBox cells = patch_cells_.grown(2 * block_);
    const IndexBox reachable{cells.min.cwiseMax(first_),
                             cells.max.cwiseMin(first_ + size_ - Vector3i::Ones())};
    const auto has_surface = [iso = bone.volume.iso()](const DensityRange& range, const IndexBox&) {
        return range.holds(iso);
    };
    // A point lies in its block.
    const Eigen::Array3f step = bone.volume.spacing().cast<float>();
    const Eigen::AlignedBox3f box{(reachable.min.cast<float>().array() - 1) * step,
                                  (reachable.max.cast<float>().array() + float(block_ + 1)) * step};
    bone.lattice.forEachLeaf(cells, has_surface, [&](LeafId leaf) {
        const Vector3i first = bone.lattice.cellsOf(leaf).min;
        // Blocks of the leaf, which has them in the order of their keys.
        const Vector3i low = floorDivided((reachable.min - first).array() + (block_ - 1), block_).cwiseMax(0),
                       high = floorDivided(reachable.max - first, block_).cwiseMin(BlockKey::kMaxPerAxis - 1);
        if ((low.array() > high.array()).any()) return;
        const BlockKeyBox keys({low, high});
        bone.shell.forEachBlock(bone.shell.followed(), leaf, [&](const ShellBlock& b, uint32_t count) {
            if (b.key[count - 1] < keys.first() || b.key[0] > keys.last()) return;
            const Vector3f center(b.center[0], b.center[1], b.center[2]);
            if (box.squaredExteriorDistance(center) > b.radius * b.radius) return;
            for (uint32_t n = 0; n < count && near_count_ < near_.size(); ++n) {
                if (!keys.contains(b.key[n])) continue;
                const Vector3i cell = first + b.key[n].index() * block_;
                near_[near_count_++] = {Vector3f(b.x[n], b.y[n], b.z[n]), b.area[n], uint32_t(index(cell))};
            }
        });
    });
}

void SurfaceShift::spreadWishes(const BoneModel& bone, SpecificEnergy& u, double share,
                                double most) noexcept {
    const Vector3f inverse = bone.volume.spacing().cwiseInverse().cast<float>();
    const int to_iso = std::min(int(bone.volume.iso()), kMaxDensity - bone.volume.iso());
    const double least_slope = kMinSlope * to_iso / bone.volume.spacing().maxCoeff();
    alignas(64) float x[kSinkBatch], y[kSinkBatch], z[kSinkBatch], recession[kSinkBatch],
        least_excess[kSinkBatch], drop[kSinkBatch], area[kSinkBatch];
    SinkingPoints wishes{x, y, z, recession, least_excess, drop, 0};
    for (const NearPatch& patch : std::span(near_).first(near_count_)) {
        const Order& order = orders_[patch.node];
        if (!(order.energy > 0)) continue;
        const Vector3i cell = floorIndices(patch.at.cwiseProduct(inverse));
        const double wanted = share * double(order.energy) / (u.ofCell(cell) * double(patch.area));
        is_too_fast_ |= wanted > most;
        const double s = std::min({wanted, double(order.depth), most});
        const int n = wishes.count++;
        x[n] = patch.at.x(), y[n] = patch.at.y(), z[n] = patch.at.z();
        area[n] = patch.area, recession[n] = float(s), least_excess[n] = float(least_slope * s);
        if (wishes.count < kSinkBatch) continue;
        spread(bone.volume, wishes, area);
        wishes.count = 0;
    }
    spread(bone.volume, wishes, area);
}

void SurfaceShift::spread(const VoxelVolume& volume, const SinkingPoints& wishes,
                          const float* areas) noexcept {
    kernels().sink_surface(densityView(volume), wishes);
    Hats hats;
    std::copy_n(wishes.x, wishes.count, hats.x);
    std::copy_n(wishes.y, wishes.count, hats.y);
    std::copy_n(wishes.z, wishes.count, hats.z);
    findBoxes(hats, wishes.count);
    for (int n = 0; n < wishes.count; ++n) {
        const VoxelHat hat = hatOf(hats, n);
        if (hat.count[0] == 0) continue;
        touch(hat);
        const size_t at = index({hat.first[0], hat.first[1], hat.first[2]});
        kernels().add_hat(hat, areas[n], wishes.drop[n], &drops_[at], &weights_[at]);
    }
}

// The surface that is to stay has its say, where the other one has.
void SurfaceShift::spreadRest(const BoneModel& bone) noexcept {
    const Vector3f inverse = bone.volume.spacing().cwiseInverse().cast<float>();
    const Eigen::Array3f first = touched_.min.cast<float>(), last = touched_.max.cast<float>();
    Hats hats;
    float areas[kSinkBatch];
    int count = 0;
    for (const NearPatch& patch : std::span(near_).first(near_count_)) {
        if (orders_[patch.node].energy > 0) continue;
        const Vector3f at = patch.at.cwiseProduct(inverse);
        const bool is_far =
            (at.array() - float(block_) >= last).any() || (at.array() + float(block_) <= first).any();
        if (is_far) continue;
        hats.x[count] = at.x(), hats.y[count] = at.y(), hats.z[count] = at.z();
        areas[count++] = patch.area;
        if (count < kSinkBatch) continue;
        addRest(hats, areas, count);
        count = 0;
    }
    addRest(hats, areas, count);
}

void SurfaceShift::addRest(Hats& hats, const float* areas, int count) noexcept {
    findBoxes(hats, count);
    for (int n = 0; n < count; ++n) {
        const VoxelHat hat = hatOf(hats, n);
        if (isAnyTouched(hat))
            kernels().add_hat_where_any(hat, areas[n],
                                        &weights_[index({hat.first[0], hat.first[1], hat.first[2]})]);
    }
}

}  // namespace bonemill
