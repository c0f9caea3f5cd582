// Reads what the scene's accuracy message asks of shell, tool and tick. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/point_shell.h"
#include "proto/scene.pb.h"

namespace bonemill {

// The settings are the preset's, with the single knobs that the scene gives.
AccuracySettings accuracyOf(const scene::Scene& scene);

// These are all settings that may be in force while the session runs: the scene's, and if it is
// switchable every preset's.
std::vector<AccuracySettings> accuracyChoices(const scene::Scene& scene);

// Which presets may be chosen while a scene runs. It keeps nothing of the scene.
class PresetRule {
  public:
    explicit PresetRule(const scene::Scene& scene);
    // Why not this one, for people; empty if it may be.
    std::string whyNot(Preset preset) const;

  private:
    bool is_switchable_;
    const char* effect_of_gradient_law_;  // null: none
};

ShellConfig shellConfigOf(const scene::Scene& scene);

// Any of the choices needs these grids beside the tool's own; they ascend.
std::vector<int> sdfRefinementsOf(const scene::Scene& scene, const scene::Tool& tool);

// The tool must not be pushed through a wall of this thickness, in m: the scene's, or one voxel.
double thinnestWall(const scene::Scene& scene, double finest_spacing);

// This is what a ball of this radius on a flat wall carries before it has passed through half of it, in N: π
// κ (R - d) d², at most its maximum over d, and what the stiffness cap leaves of it. The coupling's lasting
// pull saturates there for the burr, so that no push goes through a wall of that thickness.
double wallForce(const GradientContactConfig& contact, double radius, double wall);

// A ball of this radius never carries more however deep it goes, in N: what wallForce() has at its maximum.
double mostCarried(const GradientContactConfig& contact, double radius);

// The coupling pulls with at most this force while the tool is in use, in N: what the wall carries, but with
// its relaxing spring, which may pull as much again, no more than kOfCarried of what the ball ever does. A
// burr that is not much larger than a voxel would else be pulled through solid bone.
inline constexpr double kOfCarried = 0.8;
double saturationForceOf(const scene::Scene& scene, const scene::Tool& tool, double finest_spacing);

// These are contact, coupling and speed limits of the gradient law. What differs from tool to tool is
// saturationForceOf() alone; the budget of point tests is TickBudget's.
GradientConfig gradientConfigOf(const scene::Scene& scene);

}  // namespace bonemill
