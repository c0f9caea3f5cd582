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

// A new contact counts for the stiffness cap in proportion to its depth, so that it comes in smoothly.
constexpr double kFullShareDepth = 20e-6;  // m
double shareInContact(double distance) noexcept {
    return std::clamp(-distance / kFullShareDepth, 0.0, 1.0);
}

struct Guard {
    double w, slope;  // w(s), dw/ds
};

Guard guardAt(double s) noexcept {
    const double t = std::clamp(s / GradientContact::kGuardWidth, 0.0, 1.0);
    return {t * t * (3 - 2 * t), 6 * t * (1 - t) / GradientContact::kGuardWidth};
}

// Sums over the points in contact; the matrix's upper triangle only.
struct Sums {
    double energy = 0;
    Vector3d force = Vector3d::Zero();
    Vector3d torque = Vector3d::Zero();
    Matrix6d stiffness = Matrix6d::Zero();
    uint32_t contacts = 0;
    double max_depth = 0;

    void add(double weight, double depth, double depth_cap, const Vector3d& r, const Vector3d& n,
             const ToolSample& sample, const Matrix3d& R_VT) noexcept {
        ++contacts;
        max_depth = std::max(max_depth, depth);
        const Vector3d g = R_VT * sample.gradient;
        const double capped = std::min(depth, depth_cap);
        const double potential = capped * (depth - capped / 2);  // Ψ
        const bool has_normal = n.squaredNorm() > 0.5;
        const Guard guard = has_normal ? guardAt(-n.dot(g)) : Guard{1, 0};
        energy += weight * guard.w * potential;
        const double pull = weight * guard.w * capped;
        Vector6d J;
        J << g, r.cross(g);
        force -= pull * J.head<3>();
        torque -= pull * J.tail<3>();
        // Beyond the cap the energy grows linearly: its secant keeps the matrix's direction.
        const double k = pull / depth;
        for (int row = 0; row < 6; ++row)
            for (int column = row; column < 6; ++column) stiffness(row, column) += k * J[row] * J[column];
        if (guard.slope > 0) addGuardForce(weight * guard.slope * potential, r, n, g, sample, R_VT);
    }

    // -∂E/∂(x, ω) through w: ds/dx = H n, ds/dω = r × H n - g × n.
    void addGuardForce(double energy_slope, const Vector3d& r, const Vector3d& n, const Vector3d& g,
                       const ToolSample& sample, const Matrix3d& R_VT) noexcept {
        const Vector3d Hn = R_VT * (sample.hessian * (R_VT.transpose() * n));
        force -= energy_slope * Hn;
        torque -= energy_slope * (r.cross(Hn) - g.cross(n));
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

bool GradientContact::gather(const VoxelVolume& volume, const LeafLattice& lattice, const PointShell& shell, int level,
                             const ToolField& tool, const Pose& X_VT, double margin) noexcept {
    count_ = 0;
    touching_stiffness_ = 0;
    margin_ = margin;
    origin_ = X_VT.position;
    bool has_room = true;
    const Pose X_TV = X_VT.inverse();
    const IntoTool<float> into_tool(X_VT, Vector3d::Zero());
    const float kappa = float(config_.stiffness_per_area);
    Eigen::AlignedBox3d box = boxInV(tool.box(), X_VT);
    box.min().array() -= margin;
    box.max().array() += margin;
    PointBatch<float> batch;
    alignas(64) float distance[PointBatch<float>::kCapacity];
    lattice.forEachSurfaceLeaf(box, volume.spacing(), volume.iso(), [&](LeafId leaf) {
        if (shell.pointCount(level, leaf) == 0) return;
        const Sphere around = sphereAround(lattice.cellsOf(leaf), volume.spacing());
        if (tool.distanceBound(X_TV * around.center) > around.radius + margin) return;
        shell.forEachBlock(level, leaf, [&](const ShellBlock& block, uint32_t count) {
            into_tool.fill(batch, int(count), [&](int i) { return Coordinates{block.x[i], block.y[i], block.z[i]}; });
            tool.distances(batch, distance);
            for (uint32_t i = 0; i < count; ++i) {
                if (!(distance[i] < float(margin))) continue;
                if (count_ == candidates_.size()) {
                    has_room = false;
                    return;
                }
                const Vector3f p = (Vector3d(block.x[i], block.y[i], block.z[i]) - origin_).cast<float>();
                candidates_[count_++] = {p.x(),       p.y(),       p.z(),                block.nx[i],
                                         block.ny[i], block.nz[i], kappa * block.area[i]};
                touching_stiffness_ += shareInContact(double(distance[i])) * double(kappa * block.area[i]);
            }
        });
    });
    capStiffness(tool, X_VT);
    return has_room;
}

void GradientContact::capStiffness(const ToolField& tool, const Pose& X_VT) noexcept {
    const Pose X_TV = X_VT.inverse();
    const auto sampleOf = [&](const Candidate& c) {
        return tool.sample(X_TV * Vector3d(origin_ + Vector3d(double(c.x), double(c.y), double(c.z))));
    };
    if (touching_stiffness_ <= config_.stiffness_cap) return;
    Matrix3d stiffness = Matrix3d::Zero();  // T axes
    for (size_t i = 0; i < count_; ++i) {
        const ToolSample sample = sampleOf(candidates_[i]);
        const double share = shareInContact(sample.distance);
        if (share > 0)
            stiffness += share * double(candidates_[i].weight) * sample.gradient * sample.gradient.transpose();
    }
    for (size_t i = 0; i < count_; ++i) {
        const Vector3d g = sampleOf(candidates_[i]).gradient;
        const double in_direction = g.dot(stiffness * g);
        if (in_direction > config_.stiffness_cap)
            candidates_[i].weight *= float(config_.stiffness_cap / in_direction);
    }
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
            sums.add(double(c.weight), -double(distance[i]), depth_cap, r,
                     {double(c.nx), double(c.ny), double(c.nz)}, sample, R_VT);
        }
    }
    return sums.result();
}

template GradientContactResult GradientContact::evaluate<float>(const ToolField&, const Pose&) const noexcept;
template GradientContactResult GradientContact::evaluate<double>(const ToolField&, const Pose&) const noexcept;

}  // namespace bonemill
