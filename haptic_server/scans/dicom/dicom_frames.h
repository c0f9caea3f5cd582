// Finds where each frame of a multi-frame DICOM file lies and how it is scaled: ITK tells one place and one
// scale for all of them.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "haptic_server/scans/dicom/dicom_place.h"
#include "haptic_server/scans/dicom/dicom_traits.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

struct DicomFrame {
    DicomPlace place;
    std::optional<DicomRescale> rescale;  // nothing: its functional groups do not say it
    DicomTraits traits;                   // what its functional groups say of it
};

// There is one of every frame, from the functional groups of an enhanced image (per frame, else shared), and
// none when the file does not say for each frame where it lies. Throws UserError naming file and frame when
// what it says is no place or no scale.
std::vector<DicomFrame> readFrames(const std::filesystem::path& path);

}  // namespace bonemill
