// What is said of distances between slices: how large they are, and what lies in them that does not fit in.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_slice.h"
#include "haptic_server/scans/dicom/uneven_stack.h"

namespace bonemill {

struct SliceDistances {
    double least, median, most;  // mm
    size_t after_most;           // the slice before the largest one
};

// There are two places at least, ascending.
SliceDistances distancesOf(const std::vector<SlicePlace>& places);

double placeAlong(const Eigen::Vector3d& normal, const DicomSlice& slice);  // mm
std::string nameOfSlice(const DicomSlice& slice);
std::string nameAndPlace(const DicomSlice& slice, const Eigen::Vector3d& normal);

// Empty, or that N slices are missing that bone cannot be guessed there, and where.
std::string problemOfGap(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
                         const std::vector<DicomSlice>& strangers);

// Which of the strangers lie where a slice of the stack should, and why they are none; empty: none does.
std::string strangersInGaps(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
                            const std::vector<DicomSlice>& strangers);

}  // namespace bonemill
