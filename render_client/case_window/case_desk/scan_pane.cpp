#include "render_client/case_window/case_desk/scan_pane.h"

#include <algorithm>
#include <cmath>

#include "render_client/link/density_store/density_store.h"

namespace bonemill {
namespace {

constexpr double kMargin = 1.06;
constexpr double kInset = 14;  // pixels from the pane's edge to a handle's middle

}  // namespace

Eigen::Vector2d ScanPane::toPixel(const Eigen::Vector3d& p_W) const {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::Vector3d from_middle = (p_W - middle_W) / metres_per_pixel;
    return {width / 2.0 + view.right_W.dot(from_middle), height / 2.0 + view.down_W.dot(from_middle)};
}

Eigen::Vector3d ScanPane::toWorld(const Eigen::Vector2d& pixel) const {
    const SliceView& view = sliceViewOf(axis);
    return middle_W + metres_per_pixel * ((pixel.x() - width / 2.0) * view.right_W +
                                          (pixel.y() - height / 2.0) * view.down_W);
}

Eigen::Vector3d ScanPane::moved(const Eigen::Vector3d& p_W, const Eigen::Vector2d& pixel) const {
    Eigen::Vector3d to = toWorld(pixel);
    to[Eigen::Index(axis)] = p_W[Eigen::Index(axis)];
    return to;
}

SlicePlane ScanPane::plane(const Pose& X_WV) const {
    return slicePlane(X_WV, axis, middle_W, metres_per_pixel, width, height);
}

Eigen::AlignedBox3d boxOfScan(const VolumeGeometry& geometry) {
    DensityGrid grid;
    grid.voxels = geometry.dims;
    grid.spacing_m = geometry.spacing;
    grid.origin_m.setZero();
    return scanBox(grid, geometry.X_WV);
}

ScanPane paneOver(const Eigen::AlignedBox3d& box_W, size_t axis, int width, int height, double zoom,
                  const Eigen::Vector3d& middle_W) {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::Vector3d size = box_W.sizes();
    const double right = std::abs(view.right_W.dot(size)), down = std::abs(view.down_W.dot(size));
    ScanPane pane{axis, std::max(width, 1), std::max(height, 1), box_W.center(), 1};
    pane.metres_per_pixel = kMargin * std::max(right / pane.width, down / pane.height) / zoom;
    if (zoom > 1) pane.middle_W = middle_W;
    pane.middle_W[Eigen::Index(axis)] = middle_W[Eigen::Index(axis)];
    return pane;
}

Eigen::Vector2d handleOf(const ScanPane& pane, const Eigen::Vector3d& start_W,
                         const Eigen::Vector3d& hand_W) {
    const Eigen::Vector2d start = pane.toPixel(start_W), way = pane.toPixel(hand_W) - start;
    const Eigen::Vector2d low = Eigen::Vector2d::Constant(kInset),
                          high = Eigen::Vector2d(pane.width, pane.height) - low;
    double share = 1;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const double end = start[i] + way[i], nearest = std::clamp(end, low[i], high[i]);
        if (end != nearest && way[i] != 0) share = std::min(share, (nearest - start[i]) / way[i]);
    }
    return start + std::max(share, 0.0) * way;
}

Eigen::Vector3d turnedHand(const ScanPane& pane, const Eigen::Vector3d& start_W,
                           const Eigen::Vector3d& hand_W, const Eigen::Vector2d& pixel) {
    const Eigen::Index along = Eigen::Index(pane.axis);
    const Eigen::Vector3d outwards = (hand_W - start_W).normalized();
    Eigen::Vector3d flat = pane.moved(start_W, pixel) - start_W;
    const double reach = flat.norm() / (hand_W - start_W).norm();
    if (reach < 1e-3) return outwards;
    Eigen::Vector3d in_plane = outwards;
    in_plane[along] = 0;
    const double lean = std::clamp(std::max(in_plane.norm(), reach), 0.0, 1.0);
    Eigen::Vector3d turned = lean * flat.normalized();
    turned[along] = std::copysign(std::sqrt(1 - lean * lean), outwards[along]);
    return turned;
}

Grip gripAt(const ScanPane& pane, const CaseMarks& marks, const Eigen::Vector2d& pixel, double reach) {
    const auto isNear = [&](const Eigen::Vector3d& p_W) {
        return (pane.toPixel(p_W) - pixel).norm() <= reach;
    };
    if (marks.start_W && marks.hand_W &&
        (handleOf(pane, *marks.start_W, *marks.hand_W) - pixel).norm() <= reach)
        return Grip::kHand;
    if (marks.region_W && isNear(marks.region_W->center())) return Grip::kRegion;
    return Grip::kCross;
}

}  // namespace bonemill
