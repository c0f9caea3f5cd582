#pragma once

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"

namespace bonemill::test {

/// It returns the m³ inside the drawn surface.
inline double boneVolume(const BoneModel& bone) {
    return meshVolume(meshAll(bone.volume, bone.lattice), MeshGrid(bone.volume, bone.lattice));
}

}  // namespace bonemill::test
