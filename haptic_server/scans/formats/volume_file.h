// Reads NRRD, NIfTI and MetaImage through ITK.
#pragma once

#include <filesystem>
#include <optional>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// All throw UserError with one message that names the file. `spacing_mm` is the voxels' size, for files that
// do not say it; others are refused with it.
RawVolume importNrrd(const std::filesystem::path& path,
                     const std::optional<Eigen::Vector3d>& spacing_mm = {});
RawVolume importNifti(const std::filesystem::path& path);
RawVolume importMetaImage(const std::filesystem::path& path,
                          const std::optional<Eigen::Vector3d>& spacing_mm = {});

}  // namespace bonemill
