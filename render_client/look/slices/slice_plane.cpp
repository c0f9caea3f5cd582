#include "render_client/look/slices/slice_plane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/language/language.h"

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

constexpr double kSlack = 1e-6;  // voxels: a plane that lies on voxels needs none of the next layer

const SliceView kViews[] = {
    {Vector3d::UnitY(), -Vector3d::UnitZ()},
    {Vector3d::UnitX(), -Vector3d::UnitZ()},
    {Vector3d::UnitX(), Vector3d::UnitY()},
};
constexpr SliceLabels kOfPatient[] = {{trMark("Sagittal"), "A", "P", "S", "I"},
                                      {trMark("Coronal"), "R", "L", "S", "I"},
                                      {trMark("Axial"), "R", "L", "A", "P"}};
constexpr SliceLabels kOfScan[] = {{trMark("Across x"), "-y", "+y", "+z", "-z"},
                                   {trMark("Across y"), "-x", "+x", "+z", "-z"},
                                   {trMark("Across z"), "-x", "+x", "-y", "+y"}};

// Returns the axis of V that lies most along this one of W.
Eigen::Index axisInVolume(const Pose& X_WV, size_t axis) {
    Eigen::Index most = 0;
    X_WV.rotation.toRotationMatrix().row(Eigen::Index(axis)).cwiseAbs().maxCoeff(&most);
    return most;
}

// A brick's samples lie in this box, in voxels.
struct BrickBox {
    Vector3d middle, half;
};

BrickBox boxOf(const DensityGrid& grid, uint32_t brick) {
    const Vector3d first = firstVoxelOf(grid, brick).cast<double>();
    const Vector3d low = (first.array() - 1).max(-1.0);
    const Vector3d high = (first.array() + grid.brick_edge).min(grid.voxels.cast<double>().array());
    return {(low + high) / 2, (high - low) / 2};
}

// Seen along this direction (in voxels), does the box reach into the interval around `middle`?
bool reaches(const BrickBox& box, const Vector3d& direction, const Vector3d& middle, double half) {
    return std::abs(direction.dot(box.middle - middle)) <
           direction.cwiseAbs().dot(box.half) + half - kSlack * direction.norm();
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

const SliceView& sliceViewOf(size_t axis) {
    return kViews[axis];
}

const SliceLabels& sliceLabelsOf(size_t axis, bool are_patients_axes) {
    return are_patients_axes ? kOfPatient[axis] : kOfScan[axis];
}

Eigen::AlignedBox3d scanBox(const DensityGrid& grid, const Pose& X_WV) {
    const Eigen::AlignedBox3d box_V(
        grid.origin_m - grid.spacing_m / 2,
        grid.origin_m + grid.spacing_m.cwiseProduct((grid.voxels.cast<double>().array() - 0.5).matrix()));
    Eigen::AlignedBox3d box_W;
    for (int i = 0; i < 8; ++i) box_W.extend(X_WV * box_V.corner(Eigen::AlignedBox3d::CornerType(i)));
    return box_W;
}

double sliceStep(const DensityGrid& grid, const Pose& X_WV, size_t axis) {
    return grid.spacing_m[axisInVolume(X_WV, axis)];
}

double nearestSlice(const DensityGrid& grid, const Pose& X_WV, size_t axis, double position_W) {
    const Eigen::Index i = Eigen::Index(axis);
    const double step = sliceStep(grid, X_WV, axis), first = (X_WV * grid.origin_m)[i];
    const Eigen::AlignedBox3d box_W = scanBox(grid, X_WV);
    const double inside = std::clamp(position_W, box_W.min()[i] + step / 2,
                                     std::max(box_W.max()[i] - step / 2, box_W.min()[i] + step / 2));
    return first + std::round((inside - first) / step) * step;
}

SlicePlane slicePlane(const Pose& X_WV, size_t axis, const Vector3d& middle_W, double metres_per_pixel,
                      int width, int height) {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::Quaterniond R_VW = X_WV.rotation.conjugate();
    SlicePlane plane;
    plane.right_V = metres_per_pixel * (R_VW * view.right_W);
    plane.down_V = metres_per_pixel * (R_VW * view.down_W);
    plane.corner_V =
        X_WV.inverse() * middle_W - (width - 1) / 2.0 * plane.right_V - (height - 1) / 2.0 * plane.down_V;
    plane.width = width;
    plane.height = height;
    return plane;
}

// The pixels of a scan that does not lie oblique are its voxels, so that nothing is blurred.
SlicePlane facePlane(const DensityGrid& grid, const Pose& X_WV, size_t axis, double position_W,
                     const Eigen::AlignedBox3d& box_W, int most) {
    const SliceView& view = sliceViewOf(axis);
    Vector3d middle_W = box_W.center();
    middle_W[Eigen::Index(axis)] = position_W;
    double steps[2];
    int pixels[2];
    for (const int side : {0, 1}) {
        Eigen::Index along = 0;
        (side == 0 ? view.right_W : view.down_W).cwiseAbs().maxCoeff(&along);
        const double extent = box_W.sizes()[along];
        steps[side] = std::max(sliceStep(grid, X_WV, size_t(along)), extent / (most - 4));
        pixels[side] = 2 * int(std::ceil(extent / steps[side] / 2)) + 3;  // odd: a voxel is in the middle
        middle_W[along] = nearestSlice(grid, X_WV, size_t(along), middle_W[along]);
    }
    SlicePlane plane = slicePlane(X_WV, axis, middle_W, 1, 1, 1);
    plane.right_V *= steps[0];
    plane.down_V *= steps[1];
    plane.width = pixels[0];
    plane.height = pixels[1];
    plane.corner_V -= (plane.width - 1) / 2 * plane.right_V + (plane.height - 1) / 2 * plane.down_V;
    return plane;
}

std::vector<uint32_t> bricksIn(const DensityGrid& grid, const Eigen::AlignedBox3d& box_V) {
    const auto voxelAt = [&](const Vector3d& p_V, double beyond) -> Eigen::Vector3i {
        const Vector3d voxel =
            (p_V - grid.origin_m).cwiseQuotient(grid.spacing_m) + Vector3d::Constant(beyond);
        const Vector3d last = (grid.voxels.array() - 1).cast<double>();
        return voxel.cwiseMax(0).cwiseMin(last).cast<int>();
    };
    std::vector<uint32_t> bricks;
    if (box_V.isEmpty()) return bricks;
    const Eigen::Vector3i low = voxelAt(box_V.min(), 0) / grid.brick_edge,
                          high = voxelAt(box_V.max(), 1) / grid.brick_edge;
    for (int k = low.z(); k <= high.z(); ++k)
        for (int j = low.y(); j <= high.y(); ++j)
            for (int i = low.x(); i <= high.x(); ++i)
                bricks.push_back(brickOf(grid, grid.brick_edge * Eigen::Vector3i(i, j, k)));
    return bricks;
}

std::vector<uint32_t> bricksOf(const DensityGrid& grid, const SlicePlane& plane) {
    const auto voxels = [&](const Vector3d& v) { return v.cwiseQuotient(grid.spacing_m).eval(); };
    const Vector3d right = voxels(plane.right_V), down = voxels(plane.down_V);
    const Vector3d middle = voxels(plane.corner_V - grid.origin_m) + (plane.width - 1) / 2.0 * right +
                            (plane.height - 1) / 2.0 * down;
    const Vector3d normal = right.cross(down).normalized();
    const double skew = std::abs(right.dot(down));  // an oblique plane through voxels that are no cubes
    const double half_width = plane.width / 2.0 * right.squaredNorm() + plane.height / 2.0 * skew;
    const double half_height = plane.height / 2.0 * down.squaredNorm() + plane.width / 2.0 * skew;
    std::vector<std::pair<double, uint32_t>> found;
    for (uint32_t brick = 0; brick < uint32_t(brickCount(grid)); ++brick) {
        const BrickBox box = boxOf(grid, brick);
        if (reaches(box, normal, middle, 0) && reaches(box, right, middle, half_width) &&
            reaches(box, down, middle, half_height))
            found.emplace_back((box.middle - middle).squaredNorm(), brick);
    }
    std::ranges::sort(found);
    std::vector<uint32_t> bricks;
    for (const auto& [distance, brick] : found) bricks.push_back(brick);
    return bricks;
}

}  // namespace bonemill
