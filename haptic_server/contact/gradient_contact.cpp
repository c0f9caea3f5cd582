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
    Vector3d force = Vector3d::Zero();
    Vector3d torque = Vector3d::Zero();
    Matrix6d stiffness = Matrix6d::Zero();
    uint32_t contacts = 0;
    double max_depth = 0;

    // r: from the tool point, V.
    void add(double weight, double depth, double depth_cap, const Vector3d& r, const Vector3d& g) noexcept {
        ++contacts;
        max_depth = std::max(max_depth, depth);
        const double capped = std::min(depth, depth_cap);
        energy += weight * capped * (depth - capped / 2);
        Vector6d J;
        J << g, r.cross(g);
        force -= weight * capped * J.head<3>();
        torque -= weight * capped * J.tail<3>();
        // Beyond the cap the secant keeps the matrix's direction.
        const double k = weight * capped / depth;
        for (int row = 0; row < 6; ++row)
            for (int column = row; column < 6; ++column) stiffness(row, column) += k * J[row] * J[column];
    }

    GradientContactResult result() const noexcept {
        GradientContactResult result;
        result.term = {energy, {force, torque}, stiffness.selfadjointView<Eigen::Upper>()};
        result.contacts = contacts;
        result.max_depth = max_depth;
        return result;
    }
};

}  // namespace

GradientContact::GradientContact(const GradientContactConfig& config, size_t most_candidates)
    : config_(config), candidates_(most_candidates) {}

bool GradientContact::addCandidates(const ShellBlock& block, uint32_t i, int patch_points) noexcept {
    if (count_ + size_t(patch_points * patch_points) > candidates_.size()) return false;
    const Vector3f p = (Vector3d(block.x[i], block.y[i], block.z[i]) - origin_).cast<float>();
    const Vector3f n(block.nx[i], block.ny[i], block.nz[i]);
    const float weight = float(config_.stiffness_per_area) * block.area[i] / float(patch_points * patch_points);
    const PatchFrame frame = patchFrame(n, std::sqrt(block.area[i]) / float(patch_points));
    for (int row = 0; row < patch_points; ++row)
        for (int column = 0; column < patch_points; ++column) {
            const float u = float(column) - 0.5f * float(patch_points - 1);
            const float v = float(row) - 0.5f * float(patch_points - 1);
            const Vector3f at = p + u * frame.step_u + v * frame.step_v;
            candidates_[count_++] = {at.x(), at.y(), at.z(), n.x(), n.y(), n.z(), weight};
        }
    return true;
}

bool GradientContact::gather(const ShellView& bone, const ToolField& tool, const Pose& X_VT, double margin) noexcept {
    margin_ = margin;
    origin_ = X_VT.position;
    bool has_room = collect(bone, tool, X_VT);
    if (!has_room && bone.patch_points > 1)
        has_room = collect({bone.volume, bone.lattice, bone.shell, bone.level, 1}, tool, X_VT);
    guardFarSide(bone.volume, tool, X_VT);
    capStiffness(tool, X_VT);
    return has_room;
}

bool GradientContact::collect(const ShellView& bone, const ToolField& tool, const Pose& X_VT) noexcept {
    count_ = 0;
    touching_stiffness_ = 0;
    deepest_ = 0;
    bool has_room = true;
    const Pose X_TV = X_VT.inverse();
    const IntoTool<float> into_tool(X_VT, Vector3d::Zero());
    const float kappa = float(config_.stiffness_per_area), margin = float(margin_);
    const float refine_within = float(kRefineWithin * tool.thinnestRadius());
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
                const bool is_near = distance[i] < refine_within + patch;
                has_room = addCandidates(block, i, is_near ? bone.patch_points : 1) && has_room;
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
    alignas(64) Scalar distance[kBatch];
    Sums sums;
    for (size_t first = 0; first < count_; first += kBatch) {
        const int count = int(std::min<size_t>(kBatch, count_ - first));
        const Candidate* points = candidates_.data() + first;
        into_tool.fill(batch, count, [&](int i) { return Coordinates{points[i].x, points[i].y, points[i].z}; });
        tool.distances(batch, distance);
        for (int i = 0; i < count; ++i) {
            if (!(distance[i] < 0)) continue;
            const Candidate& c = points[i];
            const Vector3d r = Vector3d(double(c.x), double(c.y), double(c.z)) - p_OT;
            const ToolSample sample = tool.sample(Vector3d(batch.x[i], batch.y[i], batch.z[i]));
            sums.add(double(c.weight), -double(distance[i]), depth_cap, r, R_VT * sample.gradient);
        }
    }
    return sums.result();
}

template GradientContactResult GradientContact::evaluate<float>(const ToolField&, const Pose&) const noexcept;
template GradientContactResult GradientContact::evaluate<double>(const ToolField&, const Pose&) const noexcept;

}  // namespace bonemill
