#include "haptic_server/contact/gradient_contact.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/contact/tool_box.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Points with V's axes, measured from `origin`, to T.
template <class Scalar>
struct IntoTool {
    Scalar R[9];
    Scalar p[3];

    IntoTool(const Pose& X_VT, const Vector3d& origin) noexcept {
        const Matrix3d R_TV = X_VT.rotation.conjugate().toRotationMatrix();
        for (int i = 0; i < 9; ++i) R[i] = Scalar(R_TV(i / 3, i % 3));
        for (int axis = 0; axis < 3; ++axis) p[axis] = Scalar(X_VT.position[axis] - origin[axis]);
    }

    template <class PointAt>
    void fill(PointBatch<Scalar>& batch, int count, PointAt&& point_at) const noexcept {
        batch.count = count;
        for (int i = 0; i < count; ++i) {
            const auto [bx, by, bz] = point_at(i);
            const Scalar x = Scalar(bx) - p[0], y = Scalar(by) - p[1], z = Scalar(bz) - p[2];
            batch.x[i] = R[0] * x + R[1] * y + R[2] * z;
            batch.y[i] = R[3] * x + R[4] * y + R[5] * z;
            batch.z[i] = R[6] * x + R[7] * y + R[8] * z;
        }
    }
};

struct Coordinates {
    float x, y, z;
};

// Steps between neighbouring places of a square patch, at right angles to n; along the grid's axes where the surface is.
struct PatchFrame {
    Vector3f step_u, step_v;
};

PatchFrame patchFrame(const Vector3f& n, float step) noexcept {
    if (n.isZero(0)) return {Vector3f::Zero(), Vector3f::Zero()};
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    const Vector3f u = n.cross(Vector3f::Unit(least)).normalized();
    return {step * u, step * n.cross(u)};
}

// Sums over the points in contact; the matrix's upper triangle only.
struct Sums {
    double energy = 0;
    double force[3] = {}, torque[3] = {};
    double stiffness[21] = {};  // rows of the upper triangle
    uint32_t contacts = 0;
    double max_depth = 0;

    // r: from the tool point, V; g: V.
    void add(double weight, double depth, double depth_cap, const Vector3d& r, const Vector3d& g) noexcept {
        ++contacts;
        max_depth = std::max(max_depth, depth);
        const double capped = std::min(depth, depth_cap);
        energy += weight * capped * (depth - capped / 2);
        const double J[6] = {g.x(),
                             g.y(),
                             g.z(),
                             r.y() * g.z() - r.z() * g.y(),
                             r.z() * g.x() - r.x() * g.z(),
                             r.x() * g.y() - r.y() * g.x()};
        const double pull = weight * capped;
        for (int axis = 0; axis < 3; ++axis) {
            force[axis] -= pull * J[axis];
            torque[axis] -= pull * J[3 + axis];
        }
        // Beyond the cap the secant keeps the matrix's direction.
        const double k = depth > depth_cap ? pull / depth : weight;
        double* sum = stiffness;
        for (int row = 0; row < 6; ++row) {
            const double kJ = k * J[row];
            for (int column = row; column < 6; ++column) *sum++ += kJ * J[column];
        }
    }

    GradientContactResult result() const noexcept {
        GradientContactResult result;
        result.term.energy = energy;
        result.term.wrench = {Vector3d(force), Vector3d(torque)};
        const double* sum = stiffness;
        for (int row = 0; row < 6; ++row)
            for (int column = row; column < 6; ++column)
                result.term.stiffness(row, column) = result.term.stiffness(column, row) = *sum++;
        result.contacts = contacts;
        result.max_depth = max_depth;
        return result;
    }
};

}  // namespace

GradientContact::GradientContact(const GradientContactConfig& config, size_t most_candidates)
    : config_(config), candidates_(most_candidates) {}

bool GradientContact::gather(const ShellView& bone, const ToolField& tool, const Pose& X_VT, double margin) noexcept {
    margin_ = margin;
    origin_ = X_VT.position;
    const bool has_room = collect(bone, tool, X_VT);
    refine(bone.patch_points, bone.refined_points, tool.thinnestRadius());
    guardFarSide(bone.volume, tool, X_VT);
    capStiffness(tool, X_VT);
    return has_room;
}

// Splits the patches near the tool as finely as asked for and as the number of them allows.
void GradientContact::refine(int patch_points, int refined_points, double thinnest_radius) noexcept {
    const auto isNear = [within = float(kRefineWithin * thinnest_radius)](const Candidate& c) {
        return c.distance < within + std::sqrt(0.5f * c.area);
    };
    const size_t coarse = count_;
    const size_t near = size_t(std::count_if(candidates_.begin(), candidates_.begin() + std::ptrdiff_t(coarse), isNear));
    const size_t room = std::min(size_t(refined_points), candidates_.size() - (coarse - near));
    int q = patch_points;
    while (q > 1 && near * size_t(q * q) > room) --q;
    if (q == 1) return;
    for (size_t i = 0; i < coarse; ++i)
        if (isNear(candidates_[i])) splitPatch(i, q);
}

// The candidate becomes the first of its q × q places, the others follow at the end.
void GradientContact::splitPatch(size_t index, int q) noexcept {
    Candidate patch = candidates_[index];
    const Vector3f p(patch.x, patch.y, patch.z), n(patch.nx, patch.ny, patch.nz);
    const PatchFrame frame = patchFrame(n, std::sqrt(patch.area) / float(q));
    patch.weight /= float(q * q);
    for (int place = 0; place < q * q; ++place) {
        const float u = float(place % q) - 0.5f * float(q - 1), v = float(place / q) - 0.5f * float(q - 1);
        const Vector3f at = p + u * frame.step_u + v * frame.step_v;
        patch.x = at.x(), patch.y = at.y(), patch.z = at.z();
        candidates_[place == 0 ? index : count_++] = patch;
    }
}

bool GradientContact::collect(const ShellView& bone, const ToolField& tool, const Pose& X_VT) noexcept {
    count_ = 0;
    touching_stiffness_ = 0;
    deepest_ = 0;
    bool has_room = true;
    const Pose X_TV = X_VT.inverse();
    const IntoTool<float> into_tool(X_VT, Vector3d::Zero());
    const float kappa = float(config_.stiffness_per_area), margin = float(margin_);
    Eigen::AlignedBox3d box = boxInV(tool.box(), X_VT);
    box.min().array() -= margin_;
    box.max().array() += margin_;
    PointBatch<float> batch;
    alignas(64) float distance[PointBatch<float>::kCapacity];
    const Vector3d& spacing = bone.volume.spacing();
    bone.lattice.forEachSurfaceLeaf(box, spacing, bone.volume.iso(), [&](LeafId leaf) {
        if (bone.shell.pointCount(bone.level, leaf) == 0) return;
        const Sphere around = sphereAround(bone.lattice.cellsOf(leaf), spacing);
        if (tool.distanceBound(X_TV * around.center) > around.radius + margin_) return;
        bone.shell.forEachBlock(bone.level, leaf, [&](const ShellBlock& block, uint32_t count) {
            into_tool.fill(batch, int(count), [&](int i) { return Coordinates{block.x[i], block.y[i], block.z[i]}; });
            tool.distances(batch, distance);
            for (uint32_t i = 0; i < count; ++i) {
                // The patch around the point reaches this much nearer to the tool.
                const float patch = bone.patch_points > 1 ? std::sqrt(0.5f * block.area[i]) : 0;
                if (!(distance[i] < margin + patch)) continue;
                if (count_ == candidates_.size()) {
                    has_room = false;
                    return;
                }
                const Vector3f p = (Vector3d(block.x[i], block.y[i], block.z[i]) - origin_).cast<float>();
                candidates_[count_++] = {p.x(),        p.y(),        p.z(),
                                         block.nx[i],  block.ny[i],  block.nz[i],
                                         kappa * block.area[i], block.area[i], distance[i]};
                deepest_ = std::max(deepest_, -double(distance[i]));
                touching_stiffness_ += shareInContact(double(distance[i])) * double(kappa * block.area[i]);
            }
        });
    });
    return has_room;
}

template <class Scalar>
GradientContactResult GradientContact::evaluate(const ToolField& tool, const Pose& X_VT) const noexcept {
    constexpr int kBatch = PointBatch<Scalar>::kCapacity;
    const IntoTool<Scalar> into_tool(X_VT, origin_);
    const Vector3d p_OT = X_VT.position - origin_;
    const Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    const double depth_cap = kDepthCap * tool.thinnestRadius();
    PointBatch<Scalar> batch;
    SampleBatch<Scalar> at;
    Sums sums;
    for (size_t first = 0; first < count_; first += kBatch) {
        const int count = int(std::min<size_t>(kBatch, count_ - first));
        const Candidate* points = candidates_.data() + first;
        into_tool.fill(batch, count, [&](int i) { return Coordinates{points[i].x, points[i].y, points[i].z}; });
        tool.sample(batch, at);
        for (int i = 0; i < count; ++i) {
            if (!(at.distance[i] < 0)) continue;
            const Candidate& c = points[i];
            const Vector3d r = Vector3d(double(c.x), double(c.y), double(c.z)) - p_OT;
            sums.add(double(c.weight), -double(at.distance[i]), depth_cap, r,
                     R_VT * Vector3d(double(at.gx[i]), double(at.gy[i]), double(at.gz[i])));
        }
    }
    return sums.result();
}

template GradientContactResult GradientContact::evaluate<float>(const ToolField&, const Pose&) const noexcept;
template GradientContactResult GradientContact::evaluate<double>(const ToolField&, const Pose&) const noexcept;

}  // namespace bonemill
