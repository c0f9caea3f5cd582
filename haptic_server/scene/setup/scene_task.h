// Makes of a scene's `assessment` what its product is judged by, and what measures the technique. It is for
// start-up only, but for the makers of techniques.
#pragma once

#include <functional>
#include <memory>

#include "common/config/scene_file.h"
#include "haptic_server/assessment/measures/technique.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

// Null without a task. `scanned` is the bone at the start; `properties`, what it is made of, may be null if
// the scene has no materials. Imports assessment.reference.volume_path. Throws UserError, with its place in
// the scene, for a zone or structure without bone or voxels, and a reference of another grid.
std::shared_ptr<const JudgedTask> judgedTaskOf(const LoadedScene& loaded, const VoxelVolume& scanned,
                                               std::shared_ptr<const BoneProperties> properties);

// What measures the technique of an attempt at a scene must know of it. Normal threads.
TechniqueScene techniqueSceneOf(const scene::Scene& scene);

// What it returns makes one for each attempt. Whether the eye sees the burr is looked up in the bone as it is
// when a tick is added, so that `simulation` must outlive all ticks that are added.
std::function<std::unique_ptr<Technique>()> techniqueMaker(const scene::Scene& scene,
                                                           const SceneSetup& simulation);

}  // namespace bonemill
