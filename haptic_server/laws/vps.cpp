#include "haptic_server/laws/vps.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr int kClusterCells = 4;  // per axis: as many cells as a batch has points
static_assert(kClusterCells * kClusterCells * kClusterCells == PointBatch<float>::kCapacity);
constexpr double kMaxCells = 8e6;  // of the tool's box: what takes a tenth of a second
constexpr double kWider = 1.05;
constexpr double kOffGrid = 0.7071;  // of a cell

// McNeely's points are as dense as the voxels; a burr of few voxels needs more of them.
constexpr double kPointsPerRadius = 6;

double spacingFor(const SpoTool& tool, const VoxelVolume& bone) {
    return std::min(bone.spacing().minCoeff(), tool.burr.radius / kPointsPerRadius);
}

// The most that the points carry before they are too deep to find the surface.
double carriedForce(const LawConfig& config, const VoxelVolume& bone) {
    return config.points.point_stiffness * double(config.points.full_stiffness_contacts) * Vps::kLayers *
           bone.spacing().minCoeff();
}

}  // namespace

ToolPoints::ToolPoints(const ToolField& tool, double spacing) : spacing_(spacing) {
    const double box = tool.box().sizes().prod();
    while (box > kMaxCells * spacing_ * spacing_ * spacing_) spacing_ *= kWider;
    for (sample(tool); points_.size() > kMax; sample(tool))
        spacing_ *= kWider * std::sqrt(double(points_.size()) / double(kMax));
}

void ToolPoints::sample(const ToolField& tool) {
    points_.clear();
    clusters_.clear();
    const double edge = kClusterCells * spacing_;
    // A face that lay just between two layers of cells would be in neither.
    const Eigen::Vector3d low = tool.box().min().array() - kOffGrid * spacing_;
    const Eigen::Vector3i blocks =
        ((tool.box().sizes().array() + 2 * spacing_) / edge).ceil().cast<int>().matrix();
    for (int k = 0; k < blocks.z(); ++k)
        for (int j = 0; j < blocks.y(); ++j)
            for (int i = 0; i < blocks.x(); ++i) {
                const Eigen::Vector3d corner = low + edge * Eigen::Vector3d(i, j, k);
                const Eigen::Vector3d middle = corner.array() + edge / 2;
                if (tool.distanceBound(middle) <= edge) addCluster(tool, corner.array() + spacing_ / 2);
            }
}

// Of the cells from this one on, kClusterCells along each axis.
void ToolPoints::addCluster(const ToolField& tool, const Eigen::Vector3d& first_center) {
    PointBatch<float> batch;
    for (int n = 0; n < PointBatch<float>::kCapacity; ++n) {
        const Eigen::Vector3i cell(n % kClusterCells, n / kClusterCells % kClusterCells,
                                   n / (kClusterCells * kClusterCells));
        const Eigen::Vector3d p = first_center + spacing_ * cell.cast<double>();
        batch.x[n] = float(p.x()), batch.y[n] = float(p.y()), batch.z[n] = float(p.z());
    }
    batch.count = PointBatch<float>::kCapacity;
    alignas(64) float distance[PointBatch<float>::kCapacity];
    tool.distances(batch, distance);
    Cluster cluster{Eigen::Vector3d::Zero(), 0, uint32_t(points_.size()), 0};
    for (int n = 0; n < batch.count; ++n) {
        const Eigen::Vector3d center(double(batch.x[n]), double(batch.y[n]), double(batch.z[n]));
        const ToolSample at = tool.sample(center);
        const double slope = at.gradient.norm();
        // The cell is crossed if the surface, taken as plane, passes through it.
        const bool is_crossed = slope > 0.1 && std::abs(double(distance[n])) <= 0.87 * spacing_ &&
                                std::abs(at.distance) <= spacing_ / 2 * at.gradient.lpNorm<1>();
        if (!is_crossed) continue;
        const Eigen::Vector3d on_surface = center - at.distance / (slope * slope) * at.gradient;
        points_.push_back({on_surface.cast<float>(), (-at.gradient / slope).cast<float>()});
        cluster.center += on_surface;
        ++cluster.count;
    }
    if (cluster.count == 0) return;
    cluster.center /= cluster.count;
    for (const ToolPoint& point : pointsOf(cluster))
        cluster.radius = std::max(cluster.radius, (point.position.cast<double>() - cluster.center).norm());
    clusters_.push_back(cluster);
}

// Sums at unit stiffness: the stiffness of all points depends on their number.
struct Vps::Sums {
    Vector6d wrench = Vector6d::Zero();
    Matrix6d outer = Matrix6d::Zero();
    uint32_t contacts = 0;
    double max_depth = 0;  // m
};

Vps::Vps(const LawConfig& config, const SpoWorld& world, std::span<const SpoTool> tools, const SpoTool& tool,
         double dt)
    : ComparedLaw(config, world, tool, dt, carriedForce(config, world.volume)),
      inverse_spacing_(world.volume.spacing().cwiseInverse()) {
    for (const SpoTool& one : tools)
        of_tools_.push_back({one.model, ToolPoints(one.model->field({}), spacingFor(one, world.volume))});
    Vps::setTool(tool);
}

void Vps::setTool(const SpoTool& tool) noexcept {
    ComparedLaw::setTool(tool);
    for (const OfTool& one : of_tools_)
        if (one.model == tool.model) points_ = &one.points;
}

bool Vps::mayHoldBone(const Eigen::Vector3d& center, double radius) const noexcept {
    const Eigen::Array3d low = (center.array() - radius) * inverse_spacing_.array() - 1;
    const Eigen::Array3d high = (center.array() + radius) * inverse_spacing_.array() + 1;
    const Eigen::Array3d last = world().volume.dims().cast<double>().array();
    const IndexBox cells{low.max(-1.0).min(last).floor().cast<int>().matrix(),
                         high.max(-2.0).min(last - 1).floor().cast<int>().matrix()};
    bool may = false;
    const Density iso = world().volume.iso();
    world().lattice.forEachLeaf(
        cells, [&](const DensityRange& range, const IndexBox&) { return !may && range.max >= iso; },
        [&](LeafId) { may = true; });
    return may;
}

bool Vps::isBone(const Eigen::Vector3i& voxel) const noexcept {
    const VoxelVolume& bone = world().volume;
    if ((voxel.array() < 0).any() || (voxel.array() >= bone.dims().array()).any()) return false;
    return bone.ownerData()[bone.offset(voxel.x(), voxel.y(), voxel.z())] >= bone.iso();
}

// How far a point in bone is below the tangent plane, m; nothing if it is not, or finds no surface voxel.
double Vps::depthBelowSurface(const Eigen::Vector3d& p, const Eigen::Vector3d& inward) const noexcept {
    const auto voxelAt = [&](const Eigen::Vector3d& at) {
        return Eigen::Vector3i(at.cwiseProduct(inverse_spacing_).array().round().cast<int>().matrix());
    };
    Eigen::Vector3i voxel = voxelAt(p);
    if (!isBone(voxel)) return 0;
    const double layer = world().volume.spacing().minCoeff();
    for (int n = 1; n <= kLayers + 1; ++n) {
        const Eigen::Vector3i next = voxelAt(p + n * layer * inward);
        if (!isBone(next)) {
            const Eigen::Vector3d middle = world().volume.spacing().cwiseProduct(voxel.cast<double>());
            return std::max(0.0, (middle - p).dot(inward));
        }
        voxel = next;
    }
    return 0;
}

void Vps::test(const ToolPoints::Cluster& cluster, const Pose& X_VT, Sums& sums) noexcept {
    const Eigen::Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    for (const ToolPoint& point : points_->pointsOf(cluster)) {
        const Eigen::Vector3d r = R_VT * point.position.cast<double>();
        const Eigen::Vector3d inward = R_VT * point.inward.cast<double>();
        const double depth = depthBelowSurface(X_VT.position + r, inward);
        if (!(depth > 0)) continue;
        Vector6d J;
        J << inward, r.cross(inward);
        sums.wrench += depth * J;
        sums.outer += J * J.transpose();
        ++sums.contacts;
        sums.max_depth = std::max(sums.max_depth, depth);
    }
    tested_ += cluster.count;
}

ContactWrench Vps::contactAt(const Pose& X_VT) noexcept {
    constexpr double kFar = 1e3;  // m: what an int holds of voxels
    tested_ = 0;
    Sums sums;
    if (X_VT.position.cwiseAbs().maxCoeff() < kFar)
        for (const ToolPoints::Cluster& cluster : points_->clusters())
            if (mayHoldBone(X_VT * cluster.center, cluster.radius)) test(cluster, X_VT, sums);
    const double limit = double(config().points.full_stiffness_contacts);
    const double k = config().points.point_stiffness * std::min(1.0, limit / std::max(1u, sums.contacts));
    return {.wrench = {k * sums.wrench.head<3>(), k * sums.wrench.tail<3>()},
            .derivative = -k * sums.outer,
            .contacts = sums.contacts,
            .max_depth = sums.max_depth};
}

SpoStep Vps::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    SpoStep step;
    const ContactWrench contact = contactAt(X_VT);
    step.candidates = tested_;
    const EnergyTerm pull = couplingEnergy(coupling(), X_VT, X_VT_device, way());
    const Pose X_VT_end = quasiStaticStep(contact, pull, config().steps, X_VT, dt(), step);
    feel(step, X_VT_end, X_VT_device);
    return step;
}

}  // namespace bonemill
