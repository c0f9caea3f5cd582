#include <algorithm>

#include "common/config/field_unit.h"
#include "common/config/scene_check.h"
#include "common/geometry/node_mesh.h"

namespace bonemill {
namespace {

std::string pathOf(int index) {
    return "material[" + std::to_string(index) + "]";
}

void checkName(const scene::Scene& scene, int index, const RefuseField& refuse) {
    const std::string& name = scene.material(index).name();
    if (name.empty()) refuse(pathOf(index) + ".name", "is missing: say what the material is called");
    for (int k = 0; k < index; ++k)
        if (scene.material(k).name() == name)
            refuse(pathOf(index) + ".name", "= \"" + name + "\" is also what " + pathOf(k) +
                                                " is called: give each material a name of its own");
}

void checkWhere(const scene::Scene& scene, int index, const RefuseField& refuse) {
    const scene::Material& material = scene.material(index);
    const bool has_range = material.has_from_value() || material.has_below_value();
    if (!has_range && material.label_size() == 0 && material.segment_size() == 0)
        refuse(pathOf(index), "does not say where it is: give it from_value, below_value, label or segment");
    if (material.has_from_value() && material.has_below_value() &&
        material.from_value() >= material.below_value())
        refuse(pathOf(index) + ".from_value",
               "= " + numberText(material.from_value()) + " is not below below_value = " +
                   numberText(material.below_value()) + ": no voxel is of this material");
    if (material.label_size() > 0 && scene.volume().label_path().empty())
        refuse(pathOf(index) + ".label[0]", "needs volume.label_path: name the file with the labels");
    if (material.segment_size() > 0 && scene.volume().label_path().empty())
        refuse(pathOf(index) + ".segment[0]", "needs volume.label_path: name the file with the segments");
}

void checkProtection(const scene::Scene& scene, const RefuseField& refuse) {
    const bool has_protected = std::any_of(scene.material().begin(), scene.material().end(),
                                           [](const auto& material) { return material.is_protected(); });
    if (has_protected) return;
    constexpr const char* kWhy = "needs something to protect: set is_protected in at least one material";
    if (scene.effects().has_protected_structures()) refuse("effects.protected_structures", kWhy);
    if (scene.effects().has_virtual_fixture()) refuse("effects.virtual_fixture", kWhy);
}

}  // namespace

void checkMaterials(const scene::Scene& scene, const RefuseField& refuse) {
    if (scene.material_size() > kMaxVertexMaterials)
        refuse(pathOf(kMaxVertexMaterials),
               "is one material too many: a scene has at most " + std::to_string(kMaxVertexMaterials));
    for (int index = 0; index < scene.material_size(); ++index) {
        checkName(scene, index, refuse);
        checkWhere(scene, index, refuse);
    }
    checkProtection(scene, refuse);
}

}  // namespace bonemill
