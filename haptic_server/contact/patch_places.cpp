// Finer sampling of the patches near the tool.
#include <algorithm>
#include <cmath>

#include "haptic_server/contact/cell_patch.h"
#include "haptic_server/contact/gradient_contact.h"
#include "haptic_server/contact/into_tool.h"

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
void GradientContact::refine(const ShellView& bone, const ToolField& tool, const Pose& X_VT) noexcept {
    patch_memory_.nextGathering();
    if (bone.patch_points == 1) return;
    findNearestPlaces(tool, X_VT);
    const size_t coarse = count_;
    const int q_new = placesOfNewPatches(bone, coarse);
    for (size_t i = 0; i < coarse; ++i) {
        if (!isNear(candidates_[i])) continue;
        uint8_t& q = patch_memory_.placesOf(candidates_[i].patch);
        if (q == 0) q = uint8_t(q_new);
        if (q > 1 && count_ + size_t(q * q) <= candidates_.size()) splitPatch(bone.volume, i, q);
    }
}

bool GradientContact::isNear(const Candidate& c) const noexcept {
    return c.nearest < float(std::min(margin_, kRefineWithin));
}

// Per side. Known patches keep theirs, so there may be twice as many places as asked for.
int GradientContact::placesOfNewPatches(const ShellView& bone, size_t coarse) noexcept {
    size_t near = 0, fresh = 0, known_places = 0;
    for (size_t i = 0; i < coarse; ++i) {
        if (!isNear(candidates_[i])) continue;
        const size_t q = patch_memory_.placesOf(candidates_[i].patch);
        ++near;
        known_places += q * q;
        fresh += q == 0;
    }
    const size_t room = size_t(bone.refined_points);
    int q = bone.patch_points;
    while (q > 1 && (near * size_t(q * q) > room || known_places + fresh * size_t(q * q) > 2 * room)) --q;
    return q;
}

// A place of the patch is nearer than its point by what lies in the patch's plane of the way to the tool,
// and by what the bone bends towards it: as much as the thinnest tool does.
void GradientContact::findNearestPlaces(const ToolField& tool, const Pose& X_VT) noexcept {
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const IntoTool<float> into_tool(X_VT, origin_);
    const Eigen::Matrix3f R_VT = X_VT.rotation.toRotationMatrix().cast<float>();
    const float beside = float(0.5 / tool.thinnestRadius());
    PointBatch<float> batch;
    SampleBatch<float> at;
    for (size_t first = 0; first < count_; first += kBatch) {
        Candidate* points = candidates_.data() + first;
        into_tool.fill(batch, int(std::min<size_t>(kBatch, count_ - first)), [&](int i) {
            return Coordinates{points[i].x, points[i].y, points[i].z};
        });
        tool.sample(batch, at);
        for (int i = 0; i < batch.count; ++i) {
            Candidate& c = points[i];
            const Vector3f g = R_VT * Vector3f(at.gx[i], at.gy[i], at.gz[i]);
            const float in_plane = g.cross(Vector3f(c.nx, c.ny, c.nz)).norm();
            c.nearest = at.distance[i] - in_plane * std::sqrt(reach_per_area_ * c.area) - beside * c.area;
        }
    }
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
