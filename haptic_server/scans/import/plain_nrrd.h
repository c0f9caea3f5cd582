// Reads NRRD without ITK, for builds that have none: attached, three axes, one number per voxel, raw or gzip.
// Start-up only: allocates; not RT-safe.
#pragma once

#include <filesystem>
#include <optional>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// `spacing_mm` is the voxels' size, for a file that does not say it; others are refused with it. Throws
// UserError with one message that names the file: it is damaged, or of a kind that needs ITK.
RawVolume readPlainNrrd(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& spacing_mm);

}  // namespace bonemill
