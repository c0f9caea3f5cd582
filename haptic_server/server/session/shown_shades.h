// Viewers see bone whose materials are ranges of the scan's values in shades between their colours. For
// start-up; allocates.
#pragma once

#include <optional>
#include <vector>

#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "haptic_server/surface/mesh/scan_shade.h"
#include "proto/scene.pb.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct ShownShades {
    ShadeScale scale;
    std::vector<scene::Material> list;  // of each: the name of its material, and a colour
};

// Of a scene as viewers see it (shownSceneOf). None unless two materials with a colour are ranges of values
// alone, and numbers are left for some shades behind those of materials and zones.
ShownShades shadesOf(const scene::Scene& shown, const DensityMapping& mapping);

// Adds the shades behind materials and zones.
void describeShades(const ShownShades& shades, topics::SceneInfo& info);

// What the vertices of a session's bone show. The simulation, and the bone as it was scanned, must outlive
// it.
class ShownBone {
  public:
    ShownBone(const scene::Scene& scene, const SceneSetup& simulation, const VoxelVolume& scanned);
    VertexLook look() noexcept { return {properties_, shade_ ? &*shade_ : nullptr, &scanned_, &materials_}; }

  private:
    const VoxelVolume& scanned_;
    const MaterialTable& materials_;
    const BoneProperties* properties_ = nullptr;
    std::optional<ScanShade> shade_;
};

}  // namespace bonemill
