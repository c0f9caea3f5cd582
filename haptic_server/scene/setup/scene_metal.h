// Says what metal there is in the scan, and warns where it spoils the bone that is milled. It is for start-up
// only.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/scans/find_bone/metal.h"

namespace bonemill {

// `bone` is that of the whole scan, without the pieces that the scene drops; its voxels may be larger than
// the scan's. `used` are the voxels of the scan that are milled.
void remarkMetal(const LoadedScene& loaded, const Metal& metal, const VolumeGeometry& scan,
                 const VoxelVolume& bone, const IndexBox& used, std::vector<std::string>& remarks,
                 std::vector<std::string>& warnings);

}  // namespace bonemill
