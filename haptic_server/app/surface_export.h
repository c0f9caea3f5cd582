// The whole surface of the bone as it is now: for files and totals, not for streaming.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/mesh/mesh_check.h"
#include "haptic_server/tick/bone_model.h"

namespace bonemill {

// Before a run: throws UserError if the file could not be written after it; an empty path is fine. Leaves
// things as they are.
void requireWritable(const std::string& path);

std::vector<NodeMesh> meshWholeBone(const BoneModel& bone);
// Throws UserError when a file cannot be written; an empty path writes nothing.
void saveVolume(const std::string& path, const BoneModel& bone);
void saveMesh(const std::string& path, const BoneModel& bone, const std::vector<NodeMesh>& meshes);

}  // namespace bonemill
