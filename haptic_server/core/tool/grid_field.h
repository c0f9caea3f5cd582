// The tool's distances are interpolated trilinearly in a grid.
#pragma once

#include "haptic_server/core/tool/sdf_grid.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

// The gradient is that of the interpolated distance, so forces made with it conserve energy; its length
// differs from 1 by the grid's error.
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

}  // namespace bonemill
