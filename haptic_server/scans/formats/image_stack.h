// Reads a folder of pictures as a volume, one slice each, as micro-CT scanners and ImageJ write them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Are most of the folder's files PNG or TIFF? Hidden ones do not count.
bool isImageStack(const std::filesystem::path& folder);

// Grey pictures of 8 or 16 bit, all of one size, in the natural order of their names: columns go along x,
// rows along y, slices along z. `spacing_mm` is the voxels' size, which pictures do not say. Throws
// UserError.
RawVolume importImageStack(const std::filesystem::path& folder,
                           const std::optional<Eigen::Vector3d>& spacing_mm);

// Orders "a2" before "a10": numbers in names count as numbers.
bool isBeforeNaturally(const std::string& a, const std::string& b);

// Throws UserError unless all three are lengths above 0 that voxels can have.
void checkSpacing(const Eigen::Vector3d& spacing_mm, const std::string& file);

}  // namespace bonemill
