// What the scene's accuracy message asks of shell, tool and tick. Start-up only.
#pragma once

#include <vector>

#include "haptic_server/contact/point_shell.h"
#include "haptic_server/tick/haptic_tick.h"
#include "proto/scene.pb.h"

namespace bonemill {

// The preset with the single knobs that the scene gives.
AccuracySettings accuracyOf(const scene::Scene& scene);

// All that may be in force while the session runs: the scene's, and if it is switchable every preset's.
std::vector<AccuracySettings> accuracyChoices(const scene::Scene& scene);

ShellConfig shellConfigOf(const scene::Scene& scene);

// Grids beside the scene's own that any of the choices needs; ascending.
std::vector<int> sdfRefinementsOf(const scene::Scene& scene);

// Contact and coupling of the gradient law. `finest_spacing`: the volume's smallest voxel spacing, m.
GradientConfig gradientConfigOf(const scene::Scene& scene, double finest_spacing);

}  // namespace bonemill
