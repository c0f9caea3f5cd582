// A picture of a plane through the scan takes its pixels from here. The functions are pure; any thread may
// call them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"
#include "render_client/link/density_store/density_store.h"

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

}  // namespace bonemill
