#include "haptic_server/core/tool/tool_model.h"

#include <stdexcept>

namespace bonemill {
namespace {

// Far from the grid the bound is at least the way to the box outside of which nothing is inside the tool.
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

void GridField::sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept {
    for (int i = 0; i < points_T.count; ++i) {
        Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
        const Eigen::Vector3f p(points_T.x[i], points_T.y[i], points_T.z[i]);
        out.distance[i] = grid_.sampleAt(p, gradient);
        if (out.distance[i] == SdfGrid::kOutsideDistance)
            out.distance[i] = float(boundOutside(box(), p.cast<double>()));
        out.gx[i] = gradient.x(), out.gy[i] = gradient.y(), out.gz[i] = gradient.z();
    }
}

void GridField::sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept {
    for (int i = 0; i < points_T.count; ++i) {
        const ToolSample at = sample(Eigen::Vector3d(points_T.x[i], points_T.y[i], points_T.z[i]));
        out.distance[i] = at.distance;
        out.gx[i] = at.gradient.x(), out.gy[i] = at.gradient.y(), out.gz[i] = at.gradient.z();
    }
}

ToolSample GridField::sample(const Eigen::Vector3d& p_T) const noexcept {
    if (!grid_.contains(p_T)) return {boundOutside(box(), p_T), Eigen::Vector3d::Zero()};
    return {grid_.distanceExactly(p_T), grid_.gradient(p_T)};
}

double GridField::distanceBound(const Eigen::Vector3d& p_T) const noexcept {
    return grid_.contains(p_T) ? grid_.distanceExactly(p_T) - grid_.spacing() : boundOutside(box(), p_T);
}

ToolModel::ToolModel(SdfGrid grid, const std::vector<ToolShape>& shapes, double thinnest_radius)
    : thinnest_radius_(thinnest_radius) {
    if (!shapes.empty()) {
        shapes_ = std::make_unique<ShapeField>(shapes);
        thinnest_radius_ = shapes_->thinnestRadius();
    }
    refinements_.push_back(1);
    grids_.push_back(std::make_unique<GridField>(std::move(grid), thinnest_radius_));
}

void ToolModel::addRefinedGrid(int refinement, SdfGrid grid) {
    if (refinement <= refinements_.back()) throw std::invalid_argument("ToolModel: refinements must ascend");
    refinements_.push_back(refinement);
    grids_.push_back(std::make_unique<GridField>(std::move(grid), thinnest_radius_));
}

const ToolField& ToolModel::field(const AccuracySettings& settings) const noexcept {
    if (settings.tool_distance == ToolDistance::kAnalytic && shapes_) return *shapes_;
    size_t best = 0;
    for (size_t n = 1; n < grids_.size() && refinements_[n] <= settings.sdf_refinement; ++n) best = n;
    return *grids_[best];
}

}  // namespace bonemill
