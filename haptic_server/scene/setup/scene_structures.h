// The protected structures of a scene as surfaces for people to look at. Not RT-safe.
#pragma once

#include <functional>
#include <vector>

#include "common/geometry/node_mesh.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

// What makes them, on any normal thread and also when the scene is gone: one mesh (V, m) for each protected
// material that some voxel has; its leaf is the MaterialId. It is work of a second or so. Null: there are
// none.
std::function<std::vector<NodeMesh>()> structureMesherOf(const SceneSetup& simulation);

}  // namespace bonemill
