#include "haptic_server/tool/grid_field.h"

namespace bonemill {
namespace {

// Far from the grid: at least the way to the box outside of which nothing is inside the tool.
double boundOutside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& p_T) noexcept {
    return box.isEmpty() ? double(SdfGrid::kOutsideDistance) : box.exteriorDistance(p_T);
}

}  // namespace

void GridField::distances(const PointBatch<float>& points_T, float* out) const noexcept {
    for (int i = 0; i < points_T.count; ++i) {
        const Eigen::Vector3f p(points_T.x[i], points_T.y[i], points_T.z[i]);
        out[i] = grid_.distanceAt(p);
        if (out[i] == SdfGrid::kOutsideDistance) out[i] = float(boundOutside(box(), p.cast<double>()));
    }
}

void GridField::distances(const PointBatch<double>& points_T, double* out) const noexcept {
    for (int i = 0; i < points_T.count; ++i) {
        const Eigen::Vector3d p(points_T.x[i], points_T.y[i], points_T.z[i]);
        out[i] = grid_.contains(p) ? grid_.distanceExactly(p) : boundOutside(box(), p);
    }
}

ToolSample GridField::sample(const Eigen::Vector3d& p_T) const noexcept {
    if (!grid_.contains(p_T)) return {boundOutside(box(), p_T), Eigen::Vector3d::Zero()};
    return {grid_.distanceExactly(p_T), grid_.gradient(p_T)};
}

double GridField::distanceBound(const Eigen::Vector3d& p_T) const noexcept {
    return grid_.contains(p_T) ? grid_.distanceExactly(p_T) - grid_.spacing() : boundOutside(box(), p_T);
}

}  // namespace bonemill
