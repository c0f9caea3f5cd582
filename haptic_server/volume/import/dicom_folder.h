// Reads a DICOM series (folder) or one multi-frame DICOM file, through ITK's GDCMImageIO.
#pragma once

#include <filesystem>
#include <string>

#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

// Both throw UserError with one message that names the folder or file.
RawVolume importDicomFolder(const std::filesystem::path& folder, const std::string& series_uid);
RawVolume importDicomFile(const std::filesystem::path& file);

}  // namespace bonemill
