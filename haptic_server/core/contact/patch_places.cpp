// Samples the patches near the tool more finely.
#include <algorithm>
#include <array>
#include <utility>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr int kPlaceSteps = 2;         // from a place on a triangle onto the trilinear surface,
constexpr double kReachOfPlace = 0.5;  // which is never so far off, in voxels

int insideOf(const CellCorners& corners) noexcept {
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) inside |= int(corners.excess[size_t(corner)] >= 0) << corner;
    return inside;
}

// Returns where the surface crosses an edge of the cell, in cell steps.
Vector3f crossing(const CellCorners& corners, int edge) noexcept {
    const CubeEdge& e = kCubeEdges[size_t(edge)];
    const float low = corners.excess[e.low_corner], high = corners.excess[e.low_corner | 1u << e.axis];
    Vector3f at(float(e.low_corner & 1), float(e.low_corner >> 1 & 1), float(e.low_corner >> 2 & 1));
    at[e.axis] += low / (low - high);
    return at;
}

using Places = Eigen::Array<float, 4, 1>;

// Returns how far the trilinear surface is off the triangle, in m: a little more than it is at four places,
// its centroid and the middles of its edges. Does what sampleField() does.
float sagOf(const CellCorners& corners, const Vector3f (&at)[3], const Vector3f& inverse_spacing) noexcept {
    constexpr float kMore = 1.5f;
    const auto placesOf = [&](int axis) {
        const float a = at[0][axis], b = at[1][axis], c = at[2][axis];
        return Places((a + b + c) / 3, (a + b) / 2, (b + c) / 2, (c + a) / 2);
    };
    const Places x = placesOf(0), y = placesOf(1), z = placesOf(2);
    const auto& e = corners.excess;
    const Places on_x[4] = {e[0] + x * (e[1] - e[0]), e[2] + x * (e[3] - e[2]), e[4] + x * (e[5] - e[4]),
                            e[6] + x * (e[7] - e[6])};
    const Places dy_low = on_x[1] - on_x[0], dy_high = on_x[3] - on_x[2];
    const Places low = on_x[0] + y * dy_low, dz = on_x[2] + y * dy_high - low;
    const Places dx_low = (e[1] - e[0]) + y * ((e[3] - e[2]) - (e[1] - e[0]));
    const Places dx_high = (e[5] - e[4]) + y * ((e[7] - e[6]) - (e[5] - e[4]));
    const Places dx = dx_low + z * (dx_high - dx_low), dy = dy_low + z * (dy_high - dy_low);
    const Places rise = ((dx * inverse_spacing.x()).square() + (dy * inverse_spacing.y()).square() +
                         (dz * inverse_spacing.z()).square())
                            .sqrt();
    const Places sag = (low + z * dz).abs() / rise;
    return kMore * (rise > 0).select(sag, 0.0f).maxCoeff();
}

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
    const uint8_t level_of_new = pieces_.cut(most_of_new, most);
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
            for (int i = first.x(); i <= last.x(); ++i)
                if (!cutCell(bone, {i, j, k}, candidate, level)) return;
}

bool GradientContact::cutCell(const ShellView& bone, const Vector3i& cell, uint32_t candidate,
                              uint8_t level) noexcept {
    const CellCorners corners = readCorners(bone.volume, cell);
    const CubeTriangles& triangles = cubeTriangles()[size_t(insideOf(corners))];
    const Eigen::Vector3d& spacing = bone.volume.spacing();
    const Vector3f base = (cell.cast<double>().cwiseProduct(spacing) - origin_).cast<float>();
    const Vector3f steps = spacing.cast<float>();
    const Vector3f inverse_steps = steps.cwiseInverse();
    std::array<Vector3f, 12> on_edge;  // of those that the surface crosses
    unsigned known = 0;
    for (int n = 0; n < triangles.count; ++n) {
        Vector3f at[3], corner_V[3];
        for (size_t c = 0; c < 3; ++c) {
            const unsigned edge = triangles.edges[size_t(n)][c];
            if (!(known >> edge & 1)) on_edge[edge] = crossing(corners, int(edge));
            known |= 1u << edge;
            at[c] = on_edge[edge];
            corner_V[c] = base + at[c].cwiseProduct(steps);
        }
        const float sag =
            std::min(sagOf(corners, at, inverse_steps), float(kReachOfPlace) * steps.minCoeff());
        if (!pieces_.add(corner_V, sag, candidate, level)) return false;
    }
    return true;
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
