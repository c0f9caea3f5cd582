// Reads DICOM segmentations (SEG, PS3.3 A.51): label maps with named segments, drawn on the slices of a scan.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Binary segments, and fractional ones from half of their largest value on, on a grid of their own; voxels
// have the segment's number, or where segments overlap that of a combination (segments.h). The file has been
// scanned (dicom_scan.h). Throws UserError naming it.
RawVolume importDicomSegments(const std::filesystem::path& file);

// The colours are CIELab of the profile connection space (illuminant D50), PS3.3 C.10.7.1.1. Of L*, a* and b*
// as stored (L* of 0 .. 100 and a*, b* of -128 .. 127 over 0 .. 65535): red, green, blue of sRGB, 0 .. 1,
// each cut off there.
Eigen::Vector3d colorOfLab(const std::array<uint16_t, 3>& stored);

}  // namespace bonemill
