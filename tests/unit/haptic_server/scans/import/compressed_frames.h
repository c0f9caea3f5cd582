// Compresses the frames of a DICOM file, by GDCM.
#pragma once

#include <string>
#include <vector>

#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"

namespace bonemill {

// Of the words of all frames, by a transfer syntax of GDCM's list (gdcm::TransferSyntax::TSType); nothing
// where the library cannot write them so.
std::vector<std::string> compressedFrames(const std::string& words, const DicomImage& image, int frames,
                                          int syntax);

}  // namespace bonemill
