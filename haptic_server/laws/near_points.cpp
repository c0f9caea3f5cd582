#include "haptic_server/laws/near_points.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/bounded_vector.h"
#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {

namespace {

constexpr double kHalfDiagonal = 0.7071;  // of a square of side 1
constexpr int kPlaceSteps = 8;
constexpr double kCloseEnough = 0.02, kInside = 0.99, kBeyond = 0.1;  // of a disc's radius
constexpr double kFacing = 0.1;  // cosine of the angle from which on a disc is met from beside
constexpr double kRound = 0.98;  // cosine of the angle by which the tool bends from the rim to beyond
constexpr double kSmallestSlope = 1e-6;
constexpr double kShorter = 0.3;

}  // namespace

NearPoints::NearPoints(size_t most) : most_(most) {
    // The kernels go on to a multiple of their lanes.
    for (std::vector<float>* values : {&x_, &y_, &z_, &nx_, &ny_, &nz_, &disc_, &distance_})
        values->resize(most + kCellLanes + PointBatch<float>::kCapacity);
}

bool NearPoints::add(const ShellBlock& block, uint32_t count, const ToolField& tool, const Pose& X_VT,
                     float margin) noexcept {
    static_assert(ShellBlock::kCapacity <= uint32_t(PointBatch<float>::kCapacity));
    const IntoTool<float> into_tool(X_VT, Eigen::Vector3d::Zero());
    PointBatch<float> batch;
    alignas(64) float distance[PointBatch<float>::kCapacity];
    into_tool.fill(batch, block.x, block.y, block.z, int(count));
    tool.distances(batch, distance);
    for (uint32_t i = 0; i < count; ++i) {
        const float disc = float(kHalfDiagonal) * std::sqrt(block.area[i]);
        if (!(distance[i] < margin + disc)) continue;
        if (count_ == most_) return false;
        x_[count_] = float(double(block.x[i]) - origin_.x());
        y_[count_] = float(double(block.y[i]) - origin_.y());
        z_[count_] = float(double(block.z[i]) - origin_.z());
        nx_[count_] = block.nx[i], ny_[count_] = block.ny[i], nz_[count_] = block.nz[i];
        disc_[count_] = disc;
        distance_[count_++] = distance[i];
    }
    return true;
}

bool NearPoints::gather(const SpoWorld& bone, int level, const ToolField& tool, const Pose& X_VT,
                        double margin) noexcept {
    origin_ = X_VT.position;
    count_ = 0;
    Eigen::AlignedBox3d box = boxInV(tool.box(), X_VT);
    box.min().array() -= margin + bone.volume.spacing().norm();
    box.max().array() += margin + bone.volume.spacing().norm();
    const Pose X_TV = X_VT.inverse();
    const Eigen::Vector3d& spacing = bone.volume.spacing();
    const double reach = margin + spacing.norm();  // a patch is about a cell's face
    const auto mayTouch = [&](const Eigen::Vector3d& center, double radius) {
        return tool.distanceBound(X_TV * center) <= radius + reach;
    };
    bool has_room = true;
    bone.lattice.forEachSurfaceLeaf(box, spacing, bone.volume.iso(), [&](LeafId leaf) {
        if (!has_room || bone.shell.pointCount(level, leaf) == 0) return;
        const Sphere around = sphereAround(bone.lattice.cellsOf(leaf), spacing);
        if (!mayTouch(around.center, around.radius)) return;
        bone.shell.forEachBlock(level, leaf, [&](const ShellBlock& block, uint32_t count) {
            const Eigen::Vector3d center(block.center[0], block.center[1], block.center[2]);
            if (!has_room || !mayTouch(center, double(block.radius))) return;
            has_room = add(block, count, tool, X_VT, float(margin));
        });
    });
    return has_room;
}

NearPoints::Place NearPoints::nearestPlace(size_t n, const ToolField& tool, const Pose& X_VT,
                                           const Pose& X_TV) const noexcept {
    const Eigen::Vector3d center = position(n), normal_V = normal(n);
    const double disc = discRadius(n);
    ToolSample at = tool.sample(X_TV * center);
    Eigen::Vector3d offset = Eigen::Vector3d::Zero(), out = X_VT.rotation * at.gradient;
    double stride = std::max(0.0, tool.thinnestRadius() + at.distance);  // all the way for a ball
    for (int step = 0; step < kPlaceSteps && !normal_V.isZero(0); ++step) {
        const Eigen::Vector3d along = out - out.dot(normal_V) * normal_V;
        const Eigen::Vector3d next = bounded(offset - stride * along, disc);
        if ((next - offset).norm() < kCloseEnough * disc) break;
        const ToolSample there = tool.sample(X_TV * (center + next));
        if (there.distance < at.distance) {
            at = there, offset = next, out = X_VT.rotation * at.gradient;
        } else {
            stride *= kShorter;
        }
    }
    // At the rim of a disc an edge of the tool is as near to it sideways as from above; but there the next
    // disc goes on, and nothing is to be met. What is round there has its own normal.
    bool is_of_disc = offset.norm() < kInside * disc;
    const Eigen::Vector3d sideways = out - out.dot(normal_V) * normal_V;
    if (!is_of_disc && !sideways.isZero(kSmallestSlope)) {
        const Eigen::Vector3d beyond =
            center + offset - (std::abs(at.distance) + kBeyond * disc) * sideways.normalized();
        is_of_disc = (X_VT.rotation * tool.sample(X_TV * beyond).gradient).dot(out) < kRound;
    }
    is_of_disc = is_of_disc && out.dot(normal_V) < -kFacing;
    return {center + offset, at.distance, is_of_disc ? Eigen::Vector3d(-normal_V) : out};
}

void NearPoints::measure(const ToolField& tool, const Pose& X_VT, double beyond) noexcept {
    constexpr size_t kBatch = PointBatch<float>::kCapacity;
    const IntoTool<float> into_tool(X_VT, origin_);
    PointBatch<float> batch;
    for (size_t first = 0; first < count_; first += kBatch) {
        into_tool.fill(batch, &x_[first], &y_[first], &z_[first], int(std::min(kBatch, count_ - first)));
        tool.distances(batch, &distance_[first]);
    }
    const Pose X_TV = X_VT.inverse();
    for (size_t n = 0; n < count_; ++n) {
        const double nearest = distance(n) - discRadius(n);
        distance_[n] = nearest > beyond ? float(nearest) : float(nearestPlace(n, tool, X_VT, X_TV).distance);
    }
}

}  // namespace bonemill
