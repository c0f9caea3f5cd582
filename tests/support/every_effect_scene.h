// Makes a scene that lists every effect of the tick, found in the schema itself: the lower half of a cube is
// bone, with a protected layer in its depth. It is for tests and benchmarks.
#pragma once

#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bonemill::test {

struct EveryEffectBlock {
    int edge = 48;  // voxels
    double voxel_mm = 0.125;
    double burr_radius_mm = 1;
    double protected_depth_mm = 0.5;  // below the face
};

// Writes block.nrrd and labels.nrrd (1 bone, 2 protected, 0 air) to the folder.
void writeBlock(const std::string& folder, const EveryEffectBlock& block);

// These are the laws of removal, of which a scene has one.
inline constexpr const char* kByTime = "time_removal";
inline constexpr const char* kByEnergy = "energy_removal";

// The scene has the tool, materials, that volume, and every effect of the tick with its defaults, of the laws
// of removal this one.
scene::Scene everyEffectScene(const EveryEffectBlock& block, const std::string& law);

// Writes it as text to this file.
void writeScene(const std::string& file, const scene::Scene& scene);

// This is the one that is not a field of the scene's `effects`.
inline constexpr const char* kMaterialStiffness = "material_stiffness";

// They are as scene::Effects calls those of the tick.
std::vector<std::string> tickEffectNames();
scene::Scene withoutEffect(scene::Scene scene, const std::string& name);

}  // namespace bonemill::test
