#include "haptic_server/contact/gradient_contact.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/contact/into_tool.h"
#include "haptic_server/contact/tool_box.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Of the points in contact of one batch, by component: sums over them are then vector instructions.
struct ContactBatch {
    static constexpr int kCapacity = PointBatch<double>::kCapacity;
    alignas(64) double J[6][kCapacity];  // of the depth by the tool's pose, negative: g, r x g
    alignas(64) double pull[kCapacity];  // weight times capped depth
    alignas(64) double k[kCapacity];     // stiffness in J's direction
    int count = 0;
};

double dot(const double* a, const double* b, int count) noexcept {
    using Values = Eigen::Map<const Eigen::ArrayXd, Eigen::Aligned64>;
    return (Values(a, count) * Values(b, count)).sum();
}

// Sums over the points in contact; the matrix's upper triangle only.
struct Sums {
    double energy = 0;
    double force[3] = {}, torque[3] = {};
    double stiffness[21] = {};  // rows of the upper triangle
    uint32_t contacts = 0;
    double max_depth = 0;
    ContactBatch batch;

    // r: from the tool point, V; g: V.
    void add(double weight, double depth, double depth_cap, const Vector3d& r, const Vector3d& g) noexcept {
        max_depth = std::max(max_depth, depth);
        const double capped = std::min(depth, depth_cap);
        energy += weight * capped * (depth - capped / 2);
        const int i = batch.count++;
        for (int axis = 0; axis < 3; ++axis) batch.J[axis][i] = g[axis];
        batch.J[3][i] = r.y() * g.z() - r.z() * g.y();
        batch.J[4][i] = r.z() * g.x() - r.x() * g.z();
        batch.J[5][i] = r.x() * g.y() - r.y() * g.x();
        batch.pull[i] = weight * capped;
        // Beyond the cap the secant keeps the matrix's direction.
        batch.k[i] = depth > depth_cap ? batch.pull[i] / depth : weight;
    }

    // After at most a batch of points.
    void finishBatch() noexcept {
        const int n = batch.count;
        for (int axis = 0; axis < 3; ++axis) {
            force[axis] -= dot(batch.pull, batch.J[axis], n);
            torque[axis] -= dot(batch.pull, batch.J[3 + axis], n);
        }
        alignas(64) double kJ[ContactBatch::kCapacity];
        double* sum = stiffness;
        for (int row = 0; row < 6; ++row) {
            for (int i = 0; i < n; ++i) kJ[i] = batch.k[i] * batch.J[row][i];
            for (int column = row; column < 6; ++column) *sum++ += dot(kJ, batch.J[column], n);
        }
        contacts += uint32_t(n);
        batch.count = 0;
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
    : config_(config), candidates_(most_candidates), lowest_(most_candidates) {}

bool GradientContact::gather(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                             double margin) noexcept {
    margin_ = margin;
    origin_ = X_VT.position;
    const bool has_room = collect(bone, tool, X_VT);
    refine(bone, tool, X_VT);
    guardFarSide(bone.volume, tool, X_VT);
    capStiffness(tool, X_VT);
    return has_room;
}

bool GradientContact::collect(const ShellView& bone, const ToolField& tool, const Pose& X_VT) noexcept {
    const Vector3d& spacing = bone.volume.spacing();
    const double ratio = spacing.maxCoeff() / spacing.minCoeff();
    reach_per_area_ = bone.patch_points > 1 ? float((ratio + 1 / ratio) / 4) : 0;
    count_ = 0;
    touching_stiffness_ = 0;
    deepest_ = 0;
    bool has_room = true;
    const Pose X_TV = X_VT.inverse();
    const double reach = margin_ + spacing.norm();  // a patch is about a cell's face
    Eigen::AlignedBox3d box = boxInV(tool.box(), X_VT);
    box.min().array() -= reach;
    box.max().array() += reach;
    BlockBatch blocks;
    const auto test = [&] {
        has_room &= collectFrom(blocks, tool, X_VT);
        blocks.count = 0;
    };
    bone.lattice.forEachSurfaceLeaf(box, spacing, bone.volume.iso(), [&](LeafId leaf) {
        if (bone.shell.pointCount(bone.level, leaf) == 0) return;
        const Sphere around = sphereAround(bone.lattice.cellsOf(leaf), spacing);
        if (tool.distanceBound(X_TV * around.center) > around.radius + reach) return;
        bone.shell.forEachBlock(bone.level, leaf, [&](const ShellBlock& block, uint32_t count) {
            blocks.add(block, count, leaf);
            if (blocks.count == BlockBatch::kCapacity) test();
        });
    });
    test();
    return has_room;
}

// Points of the blocks that the tool may touch after a motion of at most the margin.
bool GradientContact::collectFrom(const BlockBatch& blocks, const ToolField& tool,
                                  const Pose& X_VT) noexcept {
    const IntoTool<float> into_tool(X_VT, Vector3d::Zero());
    PointBatch<float> batch;
    alignas(64) float to_block[PointBatch<float>::kCapacity], distance[PointBatch<float>::kCapacity];
    into_tool.fill(batch, blocks.count, [&](int n) {
        const float* center = blocks.block[n]->center;
        return Coordinates{center[0], center[1], center[2]};
    });
    tool.distances(batch, to_block);
    // Of the centre's distance and the points'.
    const float margin = float(margin_), error = float(2 * tool.distanceError());
    bool has_room = true;
    for (int n = 0; n < blocks.count; ++n) {
        const ShellBlock& block = *blocks.block[n];
        // A patch around a point reaches this much nearer to the tool.
        const float largest_patch = std::sqrt(reach_per_area_ * block.largest_area);
        if (to_block[n] > block.radius + margin + largest_patch + error) continue;
        into_tool.fill(batch, blocks.points[n], [&](int i) {
            return Coordinates{block.x[i], block.y[i], block.z[i]};
        });
        tool.distances(batch, distance);
        for (int i = 0; i < batch.count; ++i) {
            if (!(distance[i] < margin + largest_patch)) continue;
            const float patch = std::sqrt(reach_per_area_ * block.area[i]);
            if (distance[i] < margin + patch) has_room &= addCandidate(block, i, blocks.leaf[n], distance[i]);
        }
    }
    return has_room;
}

bool GradientContact::addCandidate(const ShellBlock& block, int i, LeafId leaf, float distance) noexcept {
    if (count_ == candidates_.size()) return false;
    const float weight = float(config_.stiffness_per_area) * block.area[i];
    const Vector3f p = (Vector3d(block.x[i], block.y[i], block.z[i]) - origin_).cast<float>();
    candidates_[count_++] = {
        p.x(),       p.y(),  p.z(),         block.nx[i], block.ny[i],
        block.nz[i], weight, block.area[i], distance,    uint64_t(leaf) << 32 | block.key[i]};
    deepest_ = std::max(deepest_, -double(distance));
    touching_stiffness_ += shareInContact(double(distance)) * double(weight);
    return true;
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
        into_tool.fill(batch, count, [&](int i) {
            return Coordinates{points[i].x, points[i].y, points[i].z};
        });
        tool.sample(batch, at);
        for (int i = 0; i < count; ++i) {
            if (!(at.distance[i] < 0)) continue;
            const Candidate& c = points[i];
            const Vector3d r = Vector3d(double(c.x), double(c.y), double(c.z)) - p_OT;
            sums.add(double(c.weight), -double(at.distance[i]), depth_cap, r,
                     R_VT * Vector3d(double(at.gx[i]), double(at.gy[i]), double(at.gz[i])));
        }
        sums.finishBatch();
    }
    return sums.result();
}

template GradientContactResult GradientContact::evaluate<float>(const ToolField&, const Pose&) const noexcept;
template GradientContactResult GradientContact::evaluate<double>(const ToolField&,
                                                                 const Pose&) const noexcept;

}  // namespace bonemill
