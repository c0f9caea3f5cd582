// Reads the values of slices, one after the other, as their headers scale them (HU for CT).
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_values.h"
#include "haptic_server/scans/dicom/dicom_slice.h"

namespace bonemill {

// Appends all of them. What is no data (Pixel Padding) becomes the lowest of all values. Returns, for people,
// what is to be said of that and of bytes that no slice needs; else an empty text. Throws UserError that
// names the file whose pixels cannot be read as they were stored.
std::string readSlices(const std::vector<DicomSlice>& slices, RawValues& values);

}  // namespace bonemill
