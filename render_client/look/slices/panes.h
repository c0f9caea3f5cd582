// Three panes in a column at the right of the picture show slices through the scan. Here is where they lie
// and what each shows. The functions are pure; any thread may call them.
//
// Positions and sizes are pixels of the picture from its upper left corner, or from that of a pane.
#pragma once

#include <optional>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

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
