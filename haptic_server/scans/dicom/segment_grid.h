// Brings the frames of a DICOM segmentation, which lie on any subset of a scan's slices, onto one grid.
//
// There is no DICOM library in here. Lengths are in mm, in LPS.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_slice.h"
#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {

// What to do with a segmentation that is not read, behind the reason.
inline constexpr char kWayOverSlicer[] = "; load it in 3D Slicer and export it as .seg.nrrd";

// How far apart slices are, as the file says; a frame's slice may have been left out for it was empty.
struct SliceSteps {
    std::optional<double> between;    // Spacing Between Slices (0018,0088)
    std::optional<double> thickness;  // Slice Thickness (0018,0050)
};

struct SegmentGrid {
    FileFrame frame;
    struct Place {
        int slice;
        Eigen::Vector2i first;  // column and row of the grid where the frame's first pixel lies
    };
    std::vector<Place> places;  // of each frame
    double aside_mm = 0;        // so far pixels are from where the file has them, within their slice
};

// `size` is the columns and rows of each frame; there is one frame at least. Frames of slices that are
// shifted sideways (a tilted gantry) go to the nearest pixel. A single slice becomes two, the second of them
// empty. Throws UserError naming `file` when orientations or pixels differ, slices are unevenly far apart, or
// no step is known.
SegmentGrid segmentGridOf(const std::vector<DicomPlace>& frames, const Eigen::Vector2i& size,
                          const SliceSteps& steps, const std::string& file);

}  // namespace bonemill
