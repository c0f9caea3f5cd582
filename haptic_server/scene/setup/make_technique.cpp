#include "haptic_server/scene/setup/make_technique.h"

#include <vector>

#include "common/config/scene_tools.h"
#include "haptic_server/scene/setup/scene_effects.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

std::vector<bool> areProtectedOf(const scene::Scene& scene) {
    std::vector<bool> are_protected;
    for (const scene::Material& material : scene.material()) are_protected.push_back(material.is_protected());
    return are_protected;
}

}  // namespace

TechniqueScene techniqueSceneOf(const scene::Scene& scene) {
    return {.recorded = recordedEffectsOf(scene.effects()),
            .materials = materialNamesOf(scene),
            .are_protected = areProtectedOf(scene),
            .tools = toolNamesOf(scene),
            .force_limit = scene.assessment().force_limit_n()};
}

// Bone that the burr touches hides nothing: the line of sight ends before it.
std::function<std::unique_ptr<Technique>()> techniqueMaker(const scene::Scene& scene,
                                                           const Simulation& simulation) {
    std::vector<double> margins;
    for (const SceneTool& tool : simulation.tools)
        margins.push_back(tool.burr.radius + simulation.bone->volume.spacing().norm());
    const VoxelVolume& volume = simulation.bone->volume;
    const auto is_hidden = [&volume, margins](const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_burr_W,
                                              uint32_t tool) {
        return isHidden(volume, p_eye_W, p_burr_W, margins[std::min(size_t(tool), margins.size() - 1)]);
    };
    return [described = techniqueSceneOf(scene), is_hidden] {
        return std::make_unique<Technique>(described, is_hidden);
    };
}

}  // namespace bonemill
