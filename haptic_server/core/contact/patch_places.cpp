// Samples the patches near the tool more finely.
#include <algorithm>
#include <utility>

#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/volume/density_view.h"

namespace bonemill {
namespace {

using Eigen::Vector3i;

constexpr int kPlaceSteps = 2;  // from a place on a triangle onto the trilinear surface

}  // namespace

// The patches near the tool are sampled as finely as asked for, and as the number of samples and the time
// allow.
void GradientContact::refine(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                             size_t most_tests) noexcept {
    split_count_ = 0;
    has_fewer_samples_ = false;
    patch_memory_.nextGathering();
    if (bone.sample_spacing > 0) cutPatches(bone, tool, X_VT, most_tests);
    candidates_.count = 0;
    takeWholePatches();
    if (split_count_ == 0) return;
    const size_t whole = candidates_.count;
    takePieces();
    movePlacesOntoSurface(bone.volume, whole);
}

void GradientContact::cutPatches(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                                 size_t most_tests) noexcept {
    pieces_.start(tool, X_VT, origin_, margin_, fineWithin(), bone.sample_spacing);
    findCoarse(tool);
    const size_t affordable = std::min(most_tests / kTestsPerSample, bone.affordable_samples);
    const size_t asked_for = size_t(bone.most_samples);
    const size_t most_of_new = std::min(asked_for, affordable),
                 most = std::min(kMaxTimes * asked_for, affordable);
    const size_t coarse = split_count_, most_pieces = piecesBeside(coarse, most_of_new);
    keepNearest(most_pieces / kPiecesPerPatch);
    has_fewer_samples_ = split_count_ < std::min(coarse, piecesBeside(coarse, asked_for) / kPiecesPerPatch);
    if (split_count_ == 0) return;
    const size_t new_count = giveCells(bone);
    const uint8_t level_of_new = pieces_.cut(bone.volume, most_pieces, most);
    has_fewer_samples_ |= pieces_.isFull() || (pieces_.isCoarse() && affordable < kMaxTimes * asked_for &&
                                               (most_of_new < asked_for || pieces_.count() > most));
    for (size_t n = 0; n < new_count; ++n) *new_level_[n] = level_of_new;
    // For want of time nothing is made coarser for good.
    const bool is_crowded = most_of_new == asked_for && pieces_.finished().size() > most_pieces;
    if (bone.may_coarsen) crowd_.coarsest = is_crowded ? level_of_new : uint8_t(0);
    point_tests_ += pieces_.takePointTests();
}

// Of the patches to be cut the farthest stay whole, where they are many.
void GradientContact::keepNearest(size_t most) noexcept {
    if (split_count_ <= most) return;
    if (most == 0) {
        split_count_ = 0;
        return;
    }
    const auto isNearer = [&](uint32_t a, uint32_t b) {
        return std::pair(near_.nearest[a], a) < std::pair(near_.nearest[b], b);
    };
    std::copy_n(split_.begin(), split_count_, source_.begin());
    const auto begin = source_.begin(), first_left_out = begin + ptrdiff_t(most);
    std::nth_element(begin, first_left_out, begin + ptrdiff_t(split_count_), isNearer);
    const auto end = std::remove_if(split_.begin(), split_.begin() + ptrdiff_t(split_count_),
                                    [&](uint32_t n) { return !isNearer(n, *first_left_out); });
    split_count_ = size_t(end - split_.begin());
}

// Lists the patches that are too large for one sample as a whole.
void GradientContact::findCoarse(const ToolField& tool) noexcept {
    const float fine_within = float(fineWithin()), thinnest = float(tool.thinnestRadius()),
                patch_reach = float(patch_reach_);
    for (size_t i = 0; i < near_.count; ++i) {
        const float near = near_.nearest[i];
        const float enough = std::min(SurfacePieces::kLengthPerDistance * near, thinnest);
        split_[split_count_] = uint32_t(i);
        split_count_ += int(near < fine_within) | int(enough < patch_reach);
    }
}

// Gives the cells of the patches to be cut. Returns how many of those are new.
size_t GradientContact::giveCells(const ShellView& bone) noexcept {
    const int factor = bone.shell.scalingFactor(bone.level);
    LeafId leaf = ~LeafId(0);  // of the patch before
    IndexBox cells;
    size_t new_count = 0, may_coarsen = bone.may_coarsen ? kMostCoarsened : 0;
    uint8_t finest = PatchMemory::kNew;
    for (size_t n = 0; n < split_count_; ++n) {
        const PatchId patch = near_.patch[split_[n]];
        if (patch.leaf != leaf) cells = bone.lattice.cellsOf(leaf = patch.leaf);
        uint8_t& level = patch_memory_.levelOf(patch);
        if (level == PatchMemory::kNew)
            new_level_[new_count++] = &level;
        else if (may_coarsen > 0 && crowd_.makesCoarser(level))
            ++level, --may_coarsen;
        finest = std::min(finest, level);
        const Vector3i first = cells.min + factor * patch.block.index();
        const Vector3i last = (first.array() + (factor - 1)).min(cells.max.array());
        for (int k = first.z(); k <= last.z(); ++k)
            for (int j = first.y(); j <= last.y(); ++j)
                for (int i = first.x(); i <= last.x(); ++i)
                    pieces_.add(bone.volume, {i, j, k}, split_[n], level);
    }
    if (bone.may_coarsen) crowd_.finest = finest;
    return new_count;
}

// The patches that are not cut are one sample each; what the tool cannot reach is left out.
void GradientContact::takeWholePatches() noexcept {
    size_t count = 0;
    const float reach = float(margin_);
    for (size_t i = 0, n = 0; i < near_.count; ++i) {
        const bool is_cut = n < split_count_ && split_[n] == i;
        n += is_cut;
        source_[count] = uint32_t(i);
        count += size_t(!is_cut && near_distance_[i] < reach);
    }
    candidates_.append(near_, source_.data(), count);
}

// Counts each patch's pieces, so that takePieces() puts them side by side. Returns how many there are.
size_t GradientContact::countPieces() noexcept {
    for (size_t n = 0; n < split_count_; ++n) next_place_[split_[n]] = 0;
    for (const SurfacePiece& piece : pieces_.finished()) ++next_place_[piece.patch];
    uint32_t count = 0;
    for (size_t n = 0; n < split_count_; ++n) count += std::exchange(next_place_[split_[n]], count);
    return count;
}

// Puts the pieces' centroids, still on their triangles, behind the other candidates, patch by patch.
void GradientContact::takePieces() noexcept {
    Candidates& c = candidates_;
    const size_t first = c.count, count = std::min(countPieces(), c.capacity() - first);
    float *x = &c.x[first], *y = &c.y[first], *z = &c.z[first], *nearest = &c.nearest[first];
    uint32_t *next = next_place_.data(), *source = source_.data();
    const auto pieces = pieces_.finished();
    for (size_t n = pieces.size(); n-- > 0;) {
        const SurfacePiece& piece = pieces[n];
        const size_t place = next[piece.patch]++;
        if (place >= count) continue;
        x[place] = piece.centroid.x(), y[place] = piece.centroid.y(), z[place] = piece.centroid.z();
        nearest[place] = piece.nearest;
        piece_area_[place] = piece.area;
        source[place] = piece.patch;
    }
    c.appendPatches(near_, source_.data(), count);
    for (size_t n = 0; n < count; ++n) c.weight[first + n] *= piece_area_[n] / c.area[first + n];
}

void GradientContact::movePlacesOntoSurface(const VoxelVolume& volume, size_t from) noexcept {
    Candidates& c = candidates_;
    kernels().move_onto_surface(
        densityView(volume, origin_), kPlaceSteps,
        {&c.x[from], &c.y[from], &c.z[from], float(SurfacePieces::kMostSag * volume.spacing().minCoeff()),
         int(c.count - from)});
}

}  // namespace bonemill
