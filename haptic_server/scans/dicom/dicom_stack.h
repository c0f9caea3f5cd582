// How slices that belong together lie: their order, their distance, and what is to be mended. There is no
// DICOM library in here.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_slice.h"
#include "haptic_server/scans/dicom/uneven_stack.h"

namespace bonemill {

struct DicomStack {
    std::vector<DicomSlice> slices;  // ascending along the normal
    double slice_spacing_mm = 0;
    std::vector<SlicePlace> places;  // of the slices, where they are to be resampled; else empty
    std::string remark;              // for people: what was mended, and how far that may be off; else empty
    std::string problem;             // for people: why it is no volume; else empty
    bool is_uneven = false;          // its slices lie at different distances
    bool has_several = false;        // two of its slices lie at one place and differ: no stack yet

    std::string name;     // for people, to choose it: its acquisition, or how it differs; one in its series
    std::string told_by;  // what told it from others of its series that overlap it; empty: there are none
};

std::string nameOfSlice(const DicomSlice& slice);  // for people: its file, and which frame of it

// Orders the slices, drops copies, and finds out how the rest lies. Slices that lie as evenly as a scanner
// rounds, and straight above each other, are taken as they are; those of a gantry tilted by up to 45 degrees,
// or at other distances, are to be resampled. `strangers` are slices of the same series that do not fit in:
// what is said of a gap names those that lie in it.
DicomStack arrangedStack(std::vector<DicomSlice> slices, const std::vector<DicomSlice>& strangers,
                         const IsSamePicture& is_same_picture);

}  // namespace bonemill
