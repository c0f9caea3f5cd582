#include "haptic_server/core/tool/tool_model.h"

#include <stdexcept>

namespace bonemill {

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
