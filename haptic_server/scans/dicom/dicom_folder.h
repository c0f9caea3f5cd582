// Reads DICOM series, through ITK's GDCMImageIO: those of a folder, or of one multi-frame file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/dicom/dicom_series.h"

namespace bonemill {

// All throw UserError with one message that names the folder or file.
RawVolume importDicomFolder(const std::filesystem::path& folder, const DicomWish& wish);

// A DICOMDIR, which names the files of a disc: the folder that it lies in is read.
bool isDicomDirectory(const std::filesystem::path& file);
RawVolume importDicomDirectory(const std::filesystem::path& file, const DicomWish& wish);

bool isDicom(const std::filesystem::path& file);

// One multi-frame file; or one slice, whose series is read of the files beside it.
RawVolume importDicomFile(const std::filesystem::path& file, const DicomWish& wish);

// A table of all stacks in the folder, or of what the file belongs to, and which to take (series_table.h).
std::vector<std::string> listDicomSeries(const std::filesystem::path& path);

}  // namespace bonemill
