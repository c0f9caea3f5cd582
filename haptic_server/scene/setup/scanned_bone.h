// From the scan's file to the bone's densities: import, iso-value, pieces, region, materials. It is for
// start-up only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {

struct ScannedBone {
    VoxelVolume volume;
    DensityMapping mapping;
    ScannedMaterials materials;
    // What each voxel of bone is made of (voxel_materials.h), x fastest; empty: what its density says, or no
    // effect asks.
    RawValues inner_values;
    std::shared_ptr<const Surroundings> surroundings;  // null: all of the scan is in the volume
    bool lacks_patient_axes;                           // RawVolume
    std::vector<std::string> remarks;                  // for people: what was read, proposed, left out
    std::vector<std::string> warnings;                 // what the user would better change in the scene
};

// Throws UserError.
ScannedBone readBone(const LoadedScene& loaded);

}  // namespace bonemill
