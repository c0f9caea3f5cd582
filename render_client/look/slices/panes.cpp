#include "render_client/look/slices/panes.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kFromTop[] = {2, 1, 0};  // the place in the column of the panes across x, y, z
constexpr double kMaxColumns = 1.0 / 3;
constexpr double kScanMargin = 1.02;  // the scan does not touch the pane's edge

int paneEdge(int width, int height) {
    const int by_height = (height - 4 * kPaneGap) / 3;
    const int by_width = int(width * kMaxColumns) - 2 * kPaneGap;
    return std::max(std::min(by_height, by_width), 1);
}

// Returns the middle that lies nearest to the wish and shows nothing but the scan, as far as that can be.
double middleWithin(double low, double high, double shown, double wish) {
    if (shown >= high - low) return (low + high) / 2;
    return std::clamp(wish, low + shown / 2, high - shown / 2);
}

}  // namespace

int paneColumns(const ViewSettings& settings, int width, int height) {
    if (!settings.slices.are_shown || settings.stereo == StereoMode::kSideBySide) return 0;
    return paneEdge(width, height) + 2 * kPaneGap;
}

std::array<PaneRect, 3> paneRects(const ViewSettings& settings, int width, int height) {
    const int edge = paneEdge(width, height), left = width - paneColumns(settings, width, height) + kPaneGap;
    const int step = (height - kPaneGap) / 3, above = kPaneGap + std::max(step - kPaneGap - edge, 0) / 2;
    std::array<PaneRect, 3> rects;
    for (size_t axis = 0; axis < 3; ++axis) rects[axis] = {left, above + step * kFromTop[axis], edge, edge};
    return rects;
}

Pane makePane(const DensityGrid& grid, const Pose& X_WV, const SliceSettings& settings, size_t axis,
              const PaneRect& rect, const std::optional<SliceBurr>& burr) {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::AlignedBox3d box_W = scanBox(grid, X_WV);
    const bool is_burr_in_scan = burr && box_W.contains(burr->p_W);
    const Vector3d focus_W = is_burr_in_scan ? burr->p_W : Vector3d(box_W.center());
    const Eigen::Index i = Eigen::Index(axis);
    Pane pane;
    pane.axis = axis;
    pane.rect = rect;
    pane.position_W = nearestSlice(grid, X_WV, axis, settings.positions[axis].value_or(focus_W[i]));
    pane.slice_step = sliceStep(grid, X_WV, axis);
    pane.first_slice_W = nearestSlice(grid, X_WV, axis, box_W.min()[i]);
    pane.last_slice_W = nearestSlice(grid, X_WV, axis, box_W.max()[i]);
    const double across = std::abs(view.right_W.dot(box_W.sizes())),
                 along = std::abs(view.down_W.dot(box_W.sizes()));
    pane.metres_per_pixel =
        kScanMargin * std::max(across / rect.width, along / rect.height) / std::max(settings.zoom, 1.0);
    Vector3d middle_W;
    const double shown[] = {pane.metres_per_pixel * rect.width, pane.metres_per_pixel * rect.height};
    for (Eigen::Index a = 0; a < 3; ++a)
        middle_W[a] = a == i ? pane.position_W
                             : middleWithin(box_W.min()[a], box_W.max()[a],
                                            shown[view.right_W[a] != 0 ? 0 : 1], focus_W[a]);
    pane.plane = slicePlane(X_WV, axis, middle_W, pane.metres_per_pixel, rect.width, rect.height);
    if (!burr) return pane;
    const Vector3d from_middle = (burr->p_W - middle_W) / pane.metres_per_pixel;
    pane.cross = Eigen::Vector2d(rect.width / 2.0 + view.right_W.dot(from_middle),
                                 rect.height / 2.0 + view.down_W.dot(from_middle));
    const double off = burr->p_W[i] - pane.position_W, squared = burr->radius * burr->radius - off * off;
    if (squared > 0) pane.circle = std::sqrt(squared) / pane.metres_per_pixel;
    return pane;
}

}  // namespace bonemill
