// Reads DICOM segmentations (SEG, PS3.3 A.51): label maps with named segments, drawn on the slices of a scan.
#pragma once

#include <filesystem>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Binary segments, and fractional ones from half of their largest value on, on a grid of their own; voxels
// have the segment's number, or where segments overlap that of a combination (segments.h). The file has been
// scanned (dicom_scan.h). Throws UserError naming it.
RawVolume importDicomSegments(const std::filesystem::path& file);

}  // namespace bonemill
