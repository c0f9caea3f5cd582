// Reads NRRD, NIfTI and MetaImage through ITK.
#pragma once

#include <filesystem>

#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

// All throw UserError with one message that names the file.
RawVolume importNrrd(const std::filesystem::path& path);
RawVolume importNifti(const std::filesystem::path& path);
RawVolume importMetaImage(const std::filesystem::path& path);

}  // namespace bonemill
