// Slices through a scan: which place a pixel shows, what the mouse has got hold of, and their pictures.
// Lengths are m in W. Pure; any thread may call it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "haptic_server/cases/casework/case_plan.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/slice_image.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// A pane with a slice across an axis of W. Pixels count from its upper left corner.
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

// The grid of its voxels, without a brick or a value.
DensityGrid gridOf(const VolumeGeometry& geometry);

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

// Everything but the window may be missing; what is pointed at must outlive the call.
struct SliceLook {
    GreyWindow window;
    std::optional<double> iso = {};            // value on the line
    const CaseBone* bone = nullptr;            // its line is drawn where bone was left out, too, but dull
    const RawVolume* labels = nullptr;         // on any grid
    std::map<uint32_t, Rgb> label_tints = {};  // by label; others are not shown
    bool operator==(const SliceLook&) const = default;
};

struct RgbaImage {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // rows from the top
    std::array<uint8_t, 4> at(int x, int y) const {
        const uint8_t* const p = rgba.data() + 4 * (size_t(y) * size_t(width) + size_t(x));
        return {p[0], p[1], p[2], p[3]};
    }
};

inline constexpr Rgb kBoneLine{255, 176, 32}, kLeftOutLine{120, 130, 150};

// A slice as a picture, with the bone's surface drawn on it: only this slice is computed, whatever the scan's
// size. The plane lies in the scan's frame V. Values are trilinear between voxels; outside of the scan it is
// black.
RgbaImage drawSlice(const RawVolume& scan, const SlicePlane& plane, const SliceLook& look);

}  // namespace bonemill
