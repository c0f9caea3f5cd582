// Samples the patches near the tool more finely.
#include <algorithm>
#include <cmath>

#include "haptic_server/contact/gradient_contact.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr int kPlaceSteps = 2;  // from a place on the tangent plane, at most half a patch away

// It has the steps between neighbouring places of a square patch, at right angles to n, and along the grid's
// axes where the surface is.
struct PatchFrame {
    Vector3f step_u, step_v;
};

PatchFrame patchFrame(const Vector3f& n, const Vector3f& spacing, float step) noexcept {
    if (n.isZero(0)) return {Vector3f::Zero(), Vector3f::Zero()};
    int least = 0, most = 0;
    n.cwiseAbs().minCoeff(&least);
    n.cwiseAbs().maxCoeff(&most);
    if (least == most) least = (most + 1) % 3;
    // u lies along the third axis, v along `least`: the patch has the proportions of the cells there.
    const float stretch = std::sqrt(spacing[3 - least - most] / spacing[least]);
    const Vector3f u = n.cross(Vector3f::Unit(least)).normalized();
    return {step * stretch * u, step / stretch * n.cross(u)};
}

}  // namespace

// The patches near the tool are sampled as finely as asked for, and as the number of near patches allows.
void GradientContact::refine(const ShellView& bone) noexcept {
    patch_memory_.nextGathering();
    if (bone.patch_points == 1) return;
    const size_t coarse = candidates_.count;
    const int q_new = placesOfNewPatches(bone, coarse);
    const Vector3f spacing = bone.volume.spacing().cast<float>();
    split_count_ = 0;
    for (size_t i = 0; i < coarse; ++i) {
        if (!isNear(i)) continue;
        uint8_t& q = patch_memory_.placesOf(candidates_.patch[i]);
        if (q == 0) q = uint8_t(q_new);
        if (q > 1 && candidates_.count + size_t(q * q) <= candidates_.capacity()) splitPatch(spacing, i, q);
    }
    movePlacesOntoSurface(bone.volume, coarse);
    fillHoles();
}

// The number is per side. Known patches keep theirs, so there may be twice as many places as asked for.
int GradientContact::placesOfNewPatches(const ShellView& bone, size_t coarse) noexcept {
    size_t near = 0, fresh = 0, known_places = 0;
    for (size_t i = 0; i < coarse; ++i) {
        if (!isNear(i)) continue;
        const size_t q = patch_memory_.placesOf(candidates_.patch[i]);
        ++near;
        known_places += q * q;
        fresh += q == 0;
    }
    const size_t room = size_t(bone.refined_points);
    int q = bone.patch_points;
    while (q > 1 && (near * size_t(q * q) > room || known_places + fresh * size_t(q * q) > 2 * room)) --q;
    return q;
}

// Puts its q × q places, still on the tangent plane, at the end of the candidates.
void GradientContact::splitPatch(const Vector3f& spacing, size_t index, int q) noexcept {
    Candidates& c = candidates_;
    const Vector3f own_point = c.position(index), n = c.normal(index);
    const float side = std::sqrt(c.area[index]);
    const PatchFrame frame = patchFrame(n, spacing, side / float(q));
    const float reach = side / 2 * std::sqrt(spacing.maxCoeff() / spacing.minCoeff());
    c.weight[index] /= float(q * q);
    for (int place = 0; place < q * q; ++place) {
        const int column = place % q, row = place / q;
        const float u = float(column) - 0.5f * float(q - 1), v = float(row) - 0.5f * float(q - 1);
        const Vector3f start = own_point + u * frame.step_u + v * frame.step_v;
        const size_t to = c.count++;
        c.copy(index, to);
        c.x[to] = start.x(), c.y[to] = start.y(), c.z[to] = start.z();
        own_x_[to] = own_point.x(), own_y_[to] = own_point.y(), own_z_[to] = own_point.z();
        reach_squared_[to] = reach * reach;
    }
    split_[split_count_++] = uint32_t(index);
}

void GradientContact::movePlacesOntoSurface(const VoxelVolume& volume, size_t coarse) noexcept {
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
                                {&c.x[coarse], &c.y[coarse], &c.z[coarse], &own_x_[coarse], &own_y_[coarse],
                                 &own_z_[coarse], &reach_squared_[coarse], int(c.count - coarse)});
}

// The last places take those of the patches that were split.
void GradientContact::fillHoles() noexcept {
    for (size_t n = 0; n < split_count_; ++n) candidates_.copy(--candidates_.count, split_[n]);
}

}  // namespace bonemill
