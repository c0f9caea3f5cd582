// The shapes of a task's zones: which voxels of a volume they hold. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// One byte per voxel of the volume, x fastest: 1 where its centre is inside one of the shapes. `path` is
// their field in the scene. Throws UserError for a shape that is no solid.
std::vector<uint8_t> voxelsInside(const LoadedScene& loaded,
                                  const google::protobuf::RepeatedPtrField<scene::Task::Shape>& shapes,
                                  const VolumeGeometry& geometry, const std::string& path);

}  // namespace bonemill
