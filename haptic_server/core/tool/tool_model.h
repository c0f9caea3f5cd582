// A tool in all the ways that the accuracy settings can ask for. Start-up builds it; then it never changes.
#pragma once

#include <memory>
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

    void distances(const PointBatch<float>& points_T, float* out) const noexcept override;
    void distances(const PointBatch<double>& points_T, double* out) const noexcept override;
    void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept override;
    void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept override;
    ToolSample sample(const Eigen::Vector3d& p_T) const noexcept override;
    double distanceError() const noexcept override { return grid_.spacing() + kRounding; }
    double distanceBound(const Eigen::Vector3d& p_T) const noexcept override;
    double testCost() const noexcept override { return 2; }

    const SdfGrid& grid() const noexcept { return grid_; }

  private:
    SdfGrid grid_;
};

class ToolModel {
  public:
    // Takes the scene's distance grid, and the shapes if the tool is made of shapes. `thinnest_radius` in m
    // is used for a tool without shapes: its burr's. It allocates.
    ToolModel(SdfGrid grid, const std::vector<ToolShape>& shapes, double thinnest_radius);

    // Adds the grid of a refinement > 1 so that settings with it find it. It allocates.
    void addRefinedGrid(int refinement, SdfGrid grid);

    // What these settings ask for, or the nearest thing there is: a tool without shapes has only grids, the
    // finest one not above the wanted refinement. It is RT-safe.
    const ToolField& field(const AccuracySettings& settings) const noexcept;
    const SdfGrid& grid() const noexcept { return grids_.front()->grid(); }
    bool hasShapes() const noexcept { return shapes_ != nullptr; }

  private:
    std::vector<int> refinements_;                   // ascending, of grids_
    std::vector<std::unique_ptr<GridField>> grids_;  // pointers stay valid when the model moves
    std::unique_ptr<ShapeField> shapes_;
    double thinnest_radius_;
};

}  // namespace bonemill
