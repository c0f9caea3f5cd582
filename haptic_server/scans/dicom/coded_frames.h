// The compressed frames of a DICOM file, each in one piece, and held against the file's header.
#pragma once

#include <gdcmSequenceOfFragments.h>

#include <string>

#include "haptic_server/scans/dicom/dicom_file.h"

namespace bonemill {

struct CodedFrames {
    gdcm::SmartPointer<gdcm::SequenceOfFragments> pieces;  // one of each frame
    unsigned bits = 0;                                     // of a value, as the pictures have it
};

// `fragments` may be null: there are none. Throws UserError naming `file` when there are not as many pictures
// as frames, or one of them contradicts the header: another size, other bits, another sign.
CodedFrames codedFramesOf(const gdcm::SequenceOfFragments* fragments, const DicomPixelLayout& layout,
                          bool is_rle, const std::string& file);

}  // namespace bonemill
