// Chooses the accuracy settings that the report compares.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "proto/scene.pb.h"

namespace bonemill {

// These are the presets, one knob at a time around balanced and thesis_2012, the cheapest there is, and the
// scene's own. Without `has_shapes` there are only grids. No two are equal.
std::vector<AccuracySettings> sweepSettings(const AccuracySettings& of_scene, bool has_shapes);

// This is the scene with every knob of its accuracy message at these settings; normals and switchable stay.
scene::Scene sceneWith(const scene::Scene& scene, const AccuracySettings& settings);

}  // namespace bonemill
