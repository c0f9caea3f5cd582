// A tool in all the ways that the accuracy settings can ask for. Start-up builds it; then it never changes.
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/tool/sdf_grid.h"
#include "haptic_server/core/tool/shape_field.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

// The tool's distances are interpolated trilinearly in a grid. The gradient is that of the interpolated
// distance, so forces made with it conserve energy; its length differs from 1 by the grid's error.
class GridField final : public ToolField {
  public:
    // `thinnest_radius` is that of the tool's thinnest part, in m.
    GridField(SdfGrid grid, double thinnest_radius)
        : ToolField(grid.box(), thinnest_radius), grid_(std::move(grid)) {}

    void distances(const PointBatch<float>& points_T, float* out) const noexcept override {
        for (int i = 0; i < points_T.count; ++i) {
            const Eigen::Vector3f p(points_T.x[i], points_T.y[i], points_T.z[i]);
            out[i] = grid_.distanceAt(p);
            if (out[i] == SdfGrid::kOutsideDistance) out[i] = float(boundOutside(p.cast<double>()));
        }
    }
    void distances(const PointBatch<double>& points_T, double* out) const noexcept override {
        for (int i = 0; i < points_T.count; ++i) {
            const Eigen::Vector3d p(points_T.x[i], points_T.y[i], points_T.z[i]);
            out[i] = grid_.contains(p) ? grid_.distanceExactly(p) : boundOutside(p);
        }
    }
    void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept override {
        for (int i = 0; i < points_T.count; ++i) {
            Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
            const Eigen::Vector3f p(points_T.x[i], points_T.y[i], points_T.z[i]);
            out.distance[i] = grid_.sampleAt(p, gradient);
            if (out.distance[i] == SdfGrid::kOutsideDistance)
                out.distance[i] = float(boundOutside(p.cast<double>()));
            out.gx[i] = gradient.x(), out.gy[i] = gradient.y(), out.gz[i] = gradient.z();
        }
    }
    void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept override {
        for (int i = 0; i < points_T.count; ++i) {
            const ToolSample at = sample(Eigen::Vector3d(points_T.x[i], points_T.y[i], points_T.z[i]));
            out.distance[i] = at.distance;
            out.gx[i] = at.gradient.x(), out.gy[i] = at.gradient.y(), out.gz[i] = at.gradient.z();
        }
    }
    ToolSample sample(const Eigen::Vector3d& p_T) const noexcept override {
        if (!grid_.contains(p_T)) return {boundOutside(p_T), Eigen::Vector3d::Zero()};
        return {grid_.distanceExactly(p_T), grid_.gradient(p_T)};
    }
    double distanceError() const noexcept override { return grid_.spacing() + kRounding; }
    double distanceBound(const Eigen::Vector3d& p_T) const noexcept override {
        return grid_.contains(p_T) ? grid_.distanceExactly(p_T) - grid_.spacing() : boundOutside(p_T);
    }
    double testCost() const noexcept override { return 2; }

    const SdfGrid& grid() const noexcept { return grid_; }

  private:
    // Far from the grid the bound is at least the way to the box outside of which nothing is inside the tool.
    double boundOutside(const Eigen::Vector3d& p_T) const noexcept {
        return box().isEmpty() ? double(SdfGrid::kOutsideDistance) : box().exteriorDistance(p_T);
    }

    SdfGrid grid_;
};

class ToolModel {
  public:
    // Takes the scene's distance grid, and the shapes if the tool is made of shapes. `thinnest_radius` in m
    // is used for a tool without shapes: its burr's. It allocates.
    ToolModel(SdfGrid grid, const std::vector<ToolShape>& shapes, double thinnest_radius)
        : thinnest_radius_(thinnest_radius) {
        if (!shapes.empty()) {
            shapes_ = std::make_unique<ShapeField>(shapes);
            thinnest_radius_ = shapes_->thinnestRadius();
        }
        refinements_.push_back(1);
        grids_.push_back(std::make_unique<GridField>(std::move(grid), thinnest_radius_));
    }

    // Adds the grid of a refinement > 1 so that settings with it find it. It allocates.
    void addRefinedGrid(int refinement, SdfGrid grid) {
        if (refinement <= refinements_.back())
            throw std::invalid_argument("ToolModel: refinements must ascend");
        refinements_.push_back(refinement);
        grids_.push_back(std::make_unique<GridField>(std::move(grid), thinnest_radius_));
    }

    // What these settings ask for, or the nearest thing there is: a tool without shapes has only grids, the
    // finest one not above the wanted refinement. It is RT-safe.
    const ToolField& field(const AccuracySettings& settings) const noexcept {
        if (settings.tool_distance == ToolDistance::kAnalytic && shapes_) return *shapes_;
        size_t best = 0;
        for (size_t n = 1; n < grids_.size() && refinements_[n] <= settings.sdf_refinement; ++n) best = n;
        return *grids_[best];
    }
    const SdfGrid& grid() const noexcept { return grids_.front()->grid(); }
    bool hasShapes() const noexcept { return shapes_ != nullptr; }

  private:
    std::vector<int> refinements_;                   // ascending, of grids_
    std::vector<std::unique_ptr<GridField>> grids_;  // pointers stay valid when the model moves
    std::unique_ptr<ShapeField> shapes_;
    double thinnest_radius_;
};

}  // namespace bonemill
