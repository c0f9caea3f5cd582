#include "haptic_server/laws/tool_points.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr int kClusterCells = 4;  // per axis: as many cells as a batch has points
static_assert(kClusterCells * kClusterCells * kClusterCells == PointBatch<float>::kCapacity);
constexpr double kMaxCells = 8e6;  // of the tool's box: what takes a tenth of a second
constexpr double kWider = 1.05;
constexpr double kOffGrid = 0.7071;  // of a cell

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

}  // namespace bonemill
