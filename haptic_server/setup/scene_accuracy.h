// What the scene's accuracy message asks of shell, tool and tick. Start-up only.
#pragma once

#include <vector>

#include "haptic_server/accuracy/accuracy_settings.h"
#include "haptic_server/contact/point_shell.h"
#include "haptic_server/spo/gradient_config.h"
#include "proto/scene.pb.h"

namespace bonemill {

// The preset with the single knobs that the scene gives.
AccuracySettings accuracyOf(const scene::Scene& scene);

// All that may be in force while the session runs: the scene's, and if it is switchable every preset's.
std::vector<AccuracySettings> accuracyChoices(const scene::Scene& scene);

ShellConfig shellConfigOf(const scene::Scene& scene);

// Grids beside the tool's own that any of the choices needs; ascending.
std::vector<int> sdfRefinementsOf(const scene::Scene& scene, const scene::Tool& tool);

// What the tool must not be pushed through, m: the scene's, or one voxel.
double thinnestWall(const scene::Scene& scene, double finest_spacing);

// What a ball of this radius on a flat wall carries before it has passed through half of it, N: π κ (R - d)
// d², at most its maximum over d, and what the stiffness cap leaves of it. The coupling's lasting pull
// saturates there for the burr, so that no push goes through a wall of that thickness.
double wallForce(const GradientContactConfig& contact, double radius, double wall);

// What the coupling pulls with at most while this tool is in use, N. `finest_spacing`: the volume's smallest
// voxel spacing, m.
double saturationForceOf(const scene::Scene& scene, const scene::Tool& tool, double finest_spacing);

// Contact and coupling of the gradient law.
GradientConfig gradientConfigOf(const scene::Scene& scene);

}  // namespace bonemill
