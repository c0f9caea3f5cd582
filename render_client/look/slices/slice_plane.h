// A picture of a plane through the scan takes its pixels from here. The functions are pure; any thread may
// call them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/pose.h"
#include "render_client/link/density_store/density_store.h"
#include "render_client/look/camera/view_settings.h"

namespace bonemill {

// The middle of pixel (column, row) lies at corner_V + column * right_V + row * down_V (V, m). Row 0 is on
// top.
struct SlicePlane {
    Eigen::Vector3d corner_V = Eigen::Vector3d::Zero();
    Eigen::Vector3d right_V = Eigen::Vector3d::UnitX(), down_V = Eigen::Vector3d::UnitY();  // of one pixel
    int width = 0, height = 0;
    bool operator==(const SlicePlane&) const = default;
};

// W is LPS, and slices lie across its axes as radiologists show them: an axial one is seen from the feet, a
// coronal one from the front, a sagittal one from the patient's left.
struct SliceView {
    Eigen::Vector3d right_W, down_W;
};
// The axis is W's x (0, sagittal), y (1, coronal) or z (2, axial).
const SliceView& sliceViewOf(size_t axis);

// Says what lies at the picture's edges: the patient's right, left, anterior, posterior, superior, inferior,
// or W's axes where the scan's file does not say how the patient lay.
struct SliceLabels {
    const char *title, *left, *right, *top, *bottom;
};
const SliceLabels& sliceLabelsOf(size_t axis, bool are_patients_axes);

// Returns the box (W, m) around all that voxels of the scan fill.
Eigen::AlignedBox3d scanBox(const DensityGrid& grid, const Pose& X_WV);

// Returns the place (W, m, along the axis) of the scan's own slice that is nearest, and the distance of its
// slices along that axis. A scan that lies oblique in W has none, but steps as large.
double sliceStep(const DensityGrid& grid, const Pose& X_WV, size_t axis);
double nearestSlice(const DensityGrid& grid, const Pose& X_WV, size_t axis, double position_W);

// Returns the plane across that axis of W at that place with this point in the picture's middle.
SlicePlane slicePlane(const Pose& X_WV, size_t axis, const Eigen::Vector3d& middle_W, double metres_per_pixel,
                      int width, int height);

// Returns the plane across that axis of W that covers the box in steps of a voxel, or larger ones where
// that took more than `most` pixels per side.
SlicePlane facePlane(const DensityGrid& grid, const Pose& X_WV, size_t axis, double position_W,
                     const Eigen::AlignedBox3d& box_W, int most);

// Returns the bricks that hold voxels of the picture, nearest to its middle first; seldom one too many.
std::vector<uint32_t> bricksOf(const DensityGrid& grid, const SlicePlane& plane);

// Returns the bricks that hold voxels around points of the box (V, m).
std::vector<uint32_t> bricksIn(const DensityGrid& grid, const Eigen::AlignedBox3d& box_V);

// Three panes in a column at the right of the picture show slices through the scan. Here is where they lie
// and what each shows.
//
// Positions and sizes are pixels of the picture from its upper left corner, or from that of a pane.
struct PaneRect {
    int x = 0, y = 0, width = 0, height = 0;
    bool holds(double at_x, double at_y) const {
        return at_x >= x && at_x < x + width && at_y >= y && at_y < y + height;
    }
    bool operator==(const PaneRect&) const = default;
};

// What stands around the panes, and between them.
inline constexpr int kPaneGap = 4;

// Returns how many columns of pixels the panes take, at most a third; 0 when none are shown. In side-by-side
// stereo there are none: they would stand before one eye.
int paneColumns(const ViewSettings& settings, int width, int height);

// Returns the panes, by the axis of W that they lie across: the axial one is on top, then the coronal and the
// sagittal one. The settings must show them.
std::array<PaneRect, 3> paneRects(const ViewSettings& settings, int width, int height);

// The burr in W.
struct SliceBurr {
    Eigen::Vector3d p_W;
    double radius = 0;  // m
};

struct Pane {
    size_t axis = 0;
    PaneRect rect;
    SlicePlane plane;
    double position_W = 0;                                       // m, along the axis
    double slice_step = 0, first_slice_W = 0, last_slice_W = 0;  // m: how it can be scrolled
    double metres_per_pixel = 1;
    std::optional<Eigen::Vector2d> cross;  // where the burr's centre is, in the pane or beside it
    double circle = 0;                     // radius of the burr where the plane cuts it; 0: it does not
};

Pane makePane(const DensityGrid& grid, const Pose& X_WV, const SliceSettings& settings, size_t axis,
              const PaneRect& rect, const std::optional<SliceBurr>& burr);

// What the user sees in them.
struct SeenPanes {
    std::array<Pane, 3> panes;
    DensityGrid grid;
    GreyWindow window;
};

}  // namespace bonemill
