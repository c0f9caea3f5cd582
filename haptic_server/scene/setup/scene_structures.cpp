#include "haptic_server/scene/setup/scene_structures.h"

#include <algorithm>

#include "haptic_server/surface/mesh/structure_mesher.h"

namespace bonemill {

std::function<std::vector<NodeMesh>()> structureMesherOf(const SceneSetup& simulation) {
    const EffectConfigs& effects = simulation.tick.effects;
    const bool are_there =
        std::ranges::any_of(effects.materials, [](const MaterialProperties& m) { return m.is_protected; });
    if (!effects.properties || !are_there) return {};
    if (simulation.labelled)
        return [labelled = simulation.labelled, materials = effects.materials] {
            return meshStructures(labelled->properties, materials, labelled->spacing, 0, labelled->X_VL);
        };
    return [properties = effects.properties, materials = effects.materials,
            spacing = simulation.bone->volume.spacing(),
            grain = simulation.label_edge] { return meshStructures(*properties, materials, spacing, grain); };
}

}  // namespace bonemill
