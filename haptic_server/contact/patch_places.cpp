// Finer sampling of the patches near the tool.
#include <algorithm>
#include <cmath>

#include "haptic_server/contact/cell_patch.h"
#include "haptic_server/contact/gradient_contact.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr int kNewtonSteps = 2;  // from a place on the tangent plane, at most half a patch away

// Steps between neighbouring places of a square patch, at right angles to n; along the grid's axes where the
// surface is.
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

// The nearest place of the trilinear iso-surface up or down the density's gradient, V; if it is not within
// `reach`, the patch's own point.
Vector3f ontoSurface(const VoxelVolume& volume, const Vector3f& start, const Vector3f& own_point,
                     float reach) noexcept {
    const Vector3f spacing = volume.spacing().cast<float>();
    Vector3f p = start;
    for (int n = 0; n < kNewtonSteps; ++n) {
        const Vector3f u = p.cwiseQuotient(spacing);
        const Eigen::Vector3i cell = u.array().floor().cast<int>().max(-1).min(volume.dims().array() - 1);
        const FieldSample field = sampleField(readCorners(volume, cell), u - cell.cast<float>());
        const Vector3f uphill = field.slope.cwiseQuotient(spacing);
        const float rise = uphill.squaredNorm();
        if (!(rise > 0)) return own_point;
        p -= field.excess / rise * uphill;
        if (!((p - start).squaredNorm() <= reach * reach)) return own_point;
    }
    return p;
}

}  // namespace

// As finely as asked for and as the number of near patches allows.
void GradientContact::refine(const ShellView& bone, double thinnest_radius) noexcept {
    const auto isNear = [beside = float(0.5 / thinnest_radius)](const Candidate& c) {
        return c.distance < float(kRefineWithin) + beside * c.area;
    };
    const size_t coarse = count_;
    const size_t near =
        size_t(std::count_if(candidates_.begin(), candidates_.begin() + std::ptrdiff_t(coarse), isNear));
    const size_t room = std::min(size_t(bone.refined_points), candidates_.size() - (coarse - near));
    int q = bone.patch_points;
    while (q > 1 && near * size_t(q * q) > room) --q;
    if (q == 1) return;
    for (size_t i = 0; i < coarse; ++i)
        if (isNear(candidates_[i])) splitPatch(bone.volume, i, q);
}

// The candidate becomes the first of its q × q places, the others follow at the end.
void GradientContact::splitPatch(const VoxelVolume& volume, size_t index, int q) noexcept {
    Candidate patch = candidates_[index];
    const Vector3f own_point = positionOf(patch).cast<float>(), n(patch.nx, patch.ny, patch.nz);
    const float side = std::sqrt(patch.area);
    const PatchFrame frame = patchFrame(n, volume.spacing().cast<float>(), side / float(q));
    const float reach =
        side / 2 * std::sqrt(float(volume.spacing().maxCoeff() / volume.spacing().minCoeff()));
    patch.weight /= float(q * q);
    for (int place = 0; place < q * q; ++place) {
        const float u = float(place % q) - 0.5f * float(q - 1), v = float(place / q) - 0.5f * float(q - 1);
        const Vector3f start = own_point + u * frame.step_u + v * frame.step_v;
        const Vector3f at =
            (ontoSurface(volume, start, own_point, reach).cast<double>() - origin_).cast<float>();
        patch.x = at.x(), patch.y = at.y(), patch.z = at.z();
        candidates_[place == 0 ? index : count_++] = patch;
    }
}

}  // namespace bonemill
