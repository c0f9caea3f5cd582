// Reads the materials of a scene: what they are, and which voxel is of which. It is for start-up only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/volume/bone_properties.h"
#include "haptic_server/volume/distance_field.h"
#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

MaterialTable materialTableOf(const scene::Scene& scene);

std::vector<std::string> materialNamesOf(const scene::Scene& scene);

// Is a viewer to show some material in its colour?
bool wantsVertexMaterials(const scene::Scene& scene);

// Does anything in the scene ask what the scanned bone was made of?
bool wantsProperties(const scene::Scene& scene);

// There is one of each raw voxel, x fastest, or none if the scene has no materials. Imports
// volume.label_path, and says it if its grid is another one. Throws UserError.
std::vector<MaterialId> materialIdsOf(const LoadedScene& loaded, const RawVolume& raw,
                                      std::vector<std::string>& remarks);

// The field is null if no effect asks for it. Throws UserError if no voxel is of a protected material.
std::shared_ptr<const DistanceField> protectedFieldOf(const LoadedScene& loaded,
                                                      const BoneProperties& properties,
                                                      const Eigen::Vector3d& spacing);

}  // namespace bonemill
