// A pane with a slice across an axis of W: which place a pixel shows, and what the mouse has got hold of.
//
// Pixels count from the pane's upper left corner, lengths are m in W. Pure; any thread may call it.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "haptic_server/cases/casework/case_plan.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

struct ScanPane {
    size_t axis = 2;  // of W: x (0, sagittal), y (1, coronal), z (2, axial)
    int width = 1, height = 1;
    Eigen::Vector3d middle_W = Eigen::Vector3d::Zero();  // seen in the pane's middle
    double metres_per_pixel = 1;

    Eigen::Vector2d toPixel(const Eigen::Vector3d& p_W) const;
    Eigen::Vector3d toWorld(const Eigen::Vector2d& pixel) const;  // in the slice
    // The point goes to the place under the pixel, and stays where it is along the pane's axis.
    Eigen::Vector3d moved(const Eigen::Vector3d& p_W, const Eigen::Vector2d& pixel) const;
    SlicePlane plane(const Pose& X_WV) const;
};

// The box around the voxels of a scan (W, m).
Eigen::AlignedBox3d boxOfScan(const VolumeGeometry& geometry);

// Sees all of the box at zoom 1; larger zooms are centred at `middle_W`, which also says where the slice is.
ScanPane paneOver(const Eigen::AlignedBox3d& box_W, size_t axis, int width, int height, double zoom,
                  const Eigen::Vector3d& middle_W);

// What can be moved on a pane.
struct CaseMarks {
    Eigen::Vector3d cross_W = Eigen::Vector3d::Zero();
    std::optional<Eigen::AlignedBox3d> region_W;
    std::optional<Eigen::Vector3d> start_W, hand_W;  // the arrow's tip on the bone, and its other end
    bool operator==(const CaseMarks& other) const {
        const auto isSameBox = [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
            return a.min() == b.min() && a.max() == b.max();
        };
        return cross_W == other.cross_W && start_W == other.start_W && hand_W == other.hand_W &&
               region_W.has_value() == other.region_W.has_value() &&
               (!region_W || isSameBox(*region_W, *other.region_W));
    }
};

// Where the arrow's end is drawn and taken: on the arrow, and within the pane.
Eigen::Vector2d handleOf(const ScanPane& pane, const Eigen::Vector3d& start_W, const Eigen::Vector3d& hand_W);

// The arrow's direction when its end is drawn to the pixel: it turns in the pane's plane, and leans into it
// as far as the pixel is away.
Eigen::Vector3d turnedHand(const ScanPane& pane, const Eigen::Vector3d& start_W,
                           const Eigen::Vector3d& hand_W, const Eigen::Vector2d& pixel);

enum class Grip { kCross, kRegion, kHand };

// What a mouse at this pixel takes: the end of the arrow or the middle of the region where it is within
// `reach` pixels of it, else the cross.
Grip gripAt(const ScanPane& pane, const CaseMarks& marks, const Eigen::Vector2d& pixel, double reach);

}  // namespace bonemill
