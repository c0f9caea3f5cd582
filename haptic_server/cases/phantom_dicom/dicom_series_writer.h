// Writes a volume as a genuine DICOM CT series: one file per slice, through ITK and GDCM.
#pragma once

#include <filesystem>
#include <string>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

struct CtSeriesText {
    std::string patient_name;  // DICOM person name
    std::string series_description;
    std::string uid_seed;  // equal seeds give equal UIDs, and equal files
};

// Values must be whole HU within int16 (they are stored as such, slope 1, intercept 0); files slice_0001.dcm
// ... in the order of the third axis. Creates the folder. Throws UserError when a file cannot be written.
void writeCtSeries(const std::filesystem::path& folder, const RawVolume& volume, const CtSeriesText& text);

// Makes a valid UID under 2.25 (UUID-derived) from any text: the same text gives the same UID.
std::string uidFromText(const std::string& text);

}  // namespace bonemill
