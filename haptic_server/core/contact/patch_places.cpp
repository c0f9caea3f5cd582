// Samples the patches near the tool more finely.
#include <algorithm>
#include <utility>

#include "haptic_server/core/contact/gradient_contact.h"

namespace bonemill {
namespace {

using Eigen::Vector3i;

constexpr int kPlaceSteps = 2;         // from a place on a triangle onto the trilinear surface,
constexpr double kReachOfPlace = 0.5;  // which is never so far off, in voxels

}  // namespace

// The patches near the tool are sampled as finely as asked for, and as the number of samples and the time
// allow.
void GradientContact::refine(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                             size_t most_tests) noexcept {
    split_count_ = 0;
    has_fewer_samples_ = false;
    patch_memory_.nextGathering();
    if (!(bone.sample_spacing > 0)) return;
    pieces_.start(tool, X_VT, origin_, margin_, fineWithin(), bone.sample_spacing);
    const size_t coarse = candidates_.count;
    for (size_t i = 0; i < coarse; ++i)
        if (isCoarse(tool, i)) split_[split_count_++] = uint32_t(i);
    const size_t affordable = std::min(most_tests / kTestsPerSample, bone.affordable_samples);
    const size_t asked_for = size_t(bone.most_samples);
    const size_t most_of_new = std::min(asked_for, affordable),
                 most = std::min(kMaxTimes * asked_for, affordable);
    if (2 * split_count_ > most_of_new) {  // there are points enough
        has_fewer_samples_ = 2 * split_count_ <= asked_for;
        split_count_ = 0;
        return;
    }
    for (size_t n = 0; n < split_count_; ++n) cutPatch(bone, split_[n]);
    const uint8_t level_of_new = pieces_.cut(bone.volume, most_of_new, most);
    has_fewer_samples_ = pieces_.isCoarse() && affordable < kMaxTimes * asked_for &&
                         (most_of_new < asked_for || pieces_.count() > most);
    for (size_t n = 0; n < split_count_; ++n)
        if (uint8_t& level = patch_memory_.levelOf(candidates_.patch[split_[n]]); level == PatchMemory::kNew)
            level = level_of_new;
    point_tests_ += pieces_.takePointTests();
    placePieces();
    movePlacesOntoSurface(bone.volume, coarse);
    fillHoles(coarse);
}

// Gives the triangles of a candidate's cells.
void GradientContact::cutPatch(const ShellView& bone, uint32_t candidate) noexcept {
    const PatchId patch = candidates_.patch[candidate];
    const uint8_t level = patch_memory_.levelOf(patch);
    const IndexBox leaf = bone.lattice.cellsOf(patch.leaf);
    const int factor = bone.shell.scalingFactor(bone.level);
    const Vector3i first = leaf.min + factor * patch.block.index();
    const Vector3i last = (first.array() + (factor - 1)).min(leaf.max.array());
    for (int k = first.z(); k <= last.z(); ++k)
        for (int j = first.y(); j <= last.y(); ++j)
            for (int i = first.x(); i <= last.x(); ++i) pieces_.add(bone.volume, {i, j, k}, candidate, level);
}

// Counts each patch's pieces, so that placePieces() puts them side by side. Returns how many there are.
size_t GradientContact::countPieces() noexcept {
    for (size_t n = 0; n < split_count_; ++n) next_place_[split_[n]] = 0;
    pieces_.forEach([&](const FinishedPiece& piece) { ++next_place_[piece.patch]; });
    uint32_t count = 0;
    for (size_t n = 0; n < split_count_; ++n) count += std::exchange(next_place_[split_[n]], count);
    return count;
}

// Puts the pieces' centroids, still on their triangles, behind the candidates, patch by patch. The first
// ones, as many as patches were cut, come last: fillHoles() takes them from there.
void GradientContact::placePieces() noexcept {
    Candidates& c = candidates_;
    const size_t coarse = c.count, count = std::min(countPieces(), c.capacity() - coarse);
    const size_t first = std::min(count, split_count_);
    pieces_.forEach([&](const FinishedPiece& piece) {
        const size_t place = next_place_[piece.patch]++;
        if (place >= count) return;
        const size_t to = coarse + (place < first ? place + count : place) - first;
        c.copy(piece.patch, to);
        c.x[to] = piece.centroid.x(), c.y[to] = piece.centroid.y(), c.z[to] = piece.centroid.z();
        c.nearest[to] = piece.nearest;
        c.weight[to] *= piece.area / c.area[to];
    });
    c.count = coarse + count;
}

void GradientContact::movePlacesOntoSurface(const VoxelVolume& volume, size_t from) noexcept {
    const BrickStore& bricks = volume.bricks();
    DensityView view{.bricks = bricks.data(),
                     .slots = bricks.slots(),
                     .bricks_x = bricks.bricksPerAxis().x(),
                     .bricks_y = bricks.bricksPerAxis().y(),
                     .dims = {volume.dims().x(), volume.dims().y(), volume.dims().z()},
                     .iso = volume.iso(),
                     .inverse_spacing = {},
                     .origin = {}};
    for (int axis = 0; axis < 3; ++axis) {
        view.inverse_spacing[axis] = float(1 / volume.spacing()[axis]);
        view.origin[axis] = float(origin_[axis]);
    }
    Candidates& c = candidates_;
    kernels().move_onto_surface(view, kPlaceSteps,
                                {&c.x[from], &c.y[from], &c.z[from],
                                 float(kReachOfPlace * volume.spacing().minCoeff()), int(c.count - from)});
}

// Closes the gap between the candidates that were not cut and the pieces, so that the pieces of a patch stay
// side by side.
void GradientContact::fillHoles(size_t coarse) noexcept {
    Candidates& c = candidates_;
    const size_t whole = coarse - split_count_;  // how many were not cut
    size_t last = split_count_;
    size_t from = coarse;
    for (size_t n = 0; n < split_count_ && split_[n] < whole; ++n) {
        while (last > 0 && split_[last - 1] == from - 1) --last, --from;
        c.copy(--from, split_[n]);
    }
    const size_t first = std::min(c.count - coarse, split_count_);
    for (size_t n = 0; n < first; ++n) c.copy(c.count - first + n, whole + n);
    c.count -= split_count_;
}

}  // namespace bonemill
