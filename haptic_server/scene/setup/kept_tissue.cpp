#include "haptic_server/scene/setup/kept_tissue.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "haptic_server/scene/setup/zone_shapes.h"

namespace bonemill {
namespace {

using IsOfMaterial = std::vector<bool>;  // by MaterialId

bool isAskedFor(const scene::Task::Zone& zone) {
    return zone.role() == scene::Task::PROTECTED || zone.role() == scene::Task::TARGET;
}

void addMaterialsOf(const scene::Scene& scene, const scene::Task::Zone& zone, IsOfMaterial& is_kept) {
    for (int n = 0; n < scene.material_size(); ++n)
        if (std::ranges::count(zone.material(), scene.material(n).name()) > 0) is_kept[size_t(n) + 1] = true;
}

IsOfMaterial protectedOf(const scene::Scene& scene) {
    IsOfMaterial is_kept(size_t(scene.material_size()) + 1);
    for (int n = 0; n < scene.material_size(); ++n) is_kept[size_t(n) + 1] = scene.material(n).is_protected();
    return is_kept;
}

}  // namespace

std::function<bool(size_t)> keptTissueOf(const LoadedScene& loaded, std::span<const MaterialId> ids,
                                         const VolumeGeometry& geometry) {
    const scene::Scene& scene = loaded.scene;
    IsOfMaterial is_kept = protectedOf(scene);
    std::vector<uint8_t> marks;  // of the zones with shapes; empty: there is none
    for (int n = 0; n < scene.assessment().zone_size(); ++n) {
        const scene::Task::Zone& zone = scene.assessment().zone(n);
        if (!isAskedFor(zone)) continue;
        if (zone.shape_size() == 0) {
            addMaterialsOf(scene, zone, is_kept);
            continue;
        }
        const auto inside =
            voxelsInside(loaded, zone.shape(), geometry, "assessment.zone[" + std::to_string(n) + "]");
        marks.resize(inside.size());
        std::ranges::transform(inside, marks, marks.begin(), std::bit_or<>());
    }
    const bool has_materials = !ids.empty() && std::ranges::count(is_kept, true) > 0;
    if (!has_materials && marks.empty()) return {};
    return [=, is_kept = std::move(is_kept), marks = std::move(marks)](size_t at) {
        return (has_materials && is_kept[ids[at]]) || (!marks.empty() && marks[at]);
    };
}

}  // namespace bonemill
