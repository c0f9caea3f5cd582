// Makes a volume of a closed surface, such as a segmented bone that was saved as STL or PLY.
#pragma once

#include <filesystem>
#include <optional>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// `path` is an .stl or .ply file in mm, LPS unless its head says SPACE=RAS as 3D Slicer writes it. Voxels are
// cubes of `voxel_mm`, by default 1/128 of the longest edge; they have `inside` in the bone and 0 outside,
// and surface_ramp.h between. Throws UserError for a mesh that is not closed or contradicts itself, and for
// too many voxels.
RawVolume importSurface(const std::filesystem::path& path, std::optional<double> voxel_mm, double inside);

}  // namespace bonemill
