// Makes of a scene's `assessment` what its product is judged by. It is for start-up only.
#pragma once

#include <memory>

#include "common/config/scene_file.h"
#include "haptic_server/assessment/product/judged_task.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Null without a task. `scanned` is the bone at the start; `properties`, what it is made of, may be null if
// the scene has no materials. Imports assessment.reference.volume_path. Throws UserError, with its place in
// the scene, for a zone or structure without bone or voxels, and a reference of another grid.
std::shared_ptr<const JudgedTask> judgedTaskOf(const LoadedScene& loaded, const VoxelVolume& scanned,
                                               std::shared_ptr<const BoneProperties> properties);

}  // namespace bonemill
