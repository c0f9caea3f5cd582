// Makes what measures the technique of an attempt at a scene. Normal threads.
#pragma once

#include <functional>
#include <memory>

#include "haptic_server/assessment/measures/technique.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

TechniqueScene techniqueSceneOf(const scene::Scene& scene);

// What it returns makes one for each attempt. Whether the eye sees the burr is looked up in the bone as it is
// when a tick is added, so that `simulation` must outlive all ticks that are added.
std::function<std::unique_ptr<Technique>()> techniqueMaker(const scene::Scene& scene,
                                                           const Simulation& simulation);

}  // namespace bonemill
