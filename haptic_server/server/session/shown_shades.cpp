#include "haptic_server/server/session/shown_shades.h"

#include <algorithm>

#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/server/session/shown_effects.h"

namespace bonemill {
namespace {

constexpr int kMostShades = 32, kFewestShades = 8;

// Bone of this raw value has the material's colour.
struct Anchor {
    double raw;
    const scene::Material* material;
};

bool isShaded(const scene::Material& material) {
    return material.has_color() && (material.has_from_value() || material.has_below_value()) &&
           material.label_size() == 0 && material.segment_size() == 0;
}

std::vector<const scene::Material*> shadedOf(const scene::Scene& scene) {
    std::vector<const scene::Material*> shaded;
    for (const scene::Material& material : scene.material())
        if (isShaded(material)) shaded.push_back(&material);
    std::ranges::stable_sort(shaded, {}, [](const scene::Material* m) {
        return m->has_from_value() ? m->from_value() : m->below_value();
    });
    return shaded;
}

// A range has its colour in its middle. One that is open at an end is taken for as wide as the others are on
// average, or, where all are open, for one that lies at its bound.
std::vector<Anchor> anchorsOf(const std::vector<const scene::Material*>& shaded) {
    double width = 0;
    int closed = 0;
    for (const scene::Material* m : shaded) {
        if (!m->has_from_value() || !m->has_below_value()) continue;
        width += m->below_value() - m->from_value();
        ++closed;
    }
    const double half = closed > 0 ? width / closed / 2 : 0;
    std::vector<Anchor> anchors;
    for (const scene::Material* m : shaded) {
        const double low = m->has_from_value() ? m->from_value() : m->below_value() - 2 * half;
        const double high = m->has_below_value() ? m->below_value() : m->from_value() + 2 * half;
        anchors.push_back({(low + high) / 2, m});
    }
    std::ranges::stable_sort(anchors, {}, &Anchor::raw);
    return anchors;
}

// It has the name of the material that bone of that value is of: what a viewer does for one by name, it does
// for its shades.
scene::Material shadeAt(const std::vector<Anchor>& anchors, double raw) {
    const auto is_above = [raw](const Anchor& a) { return a.raw >= raw; };
    const auto found = std::find_if(anchors.begin() + 1, anchors.end() - 1, is_above);
    const scene::Material &low = *(found - 1)->material, &high = *found->material;
    const double span = found->raw - (found - 1)->raw;
    const double share = span > 0 ? (raw - (found - 1)->raw) / span : 1;
    const auto mix = [share](double a, double b) { return a + share * (b - a); };
    const bool is_high = high.has_from_value() && raw >= high.from_value();
    scene::Material shade;
    shade.set_name(is_high ? high.name() : low.name());
    shade.mutable_color()->set_red(mix(low.color().red(), high.color().red()));
    shade.mutable_color()->set_green(mix(low.color().green(), high.color().green()));
    shade.mutable_color()->set_blue(mix(low.color().blue(), high.color().blue()));
    return shade;
}

}  // namespace

ShownShades shadesOf(const scene::Scene& shown, const DensityMapping& mapping) {
    const std::vector<const scene::Material*> shaded = shadedOf(shown);
    const std::vector<Anchor> anchors = anchorsOf(shaded);
    ShownShades shades;
    const int first = shown.material_size() + shownZones(shown) + 1;
    const int count = std::min(kMostShades, kMaxMaterials - first + 1);
    if (shaded.size() < 2 || count < kFewestShades) return shades;
    const Density low = mapping.density(anchors.front().raw);
    const Density high = mapping.density(anchors.back().raw);
    if (low >= high) return shades;
    shades.scale = {uint8_t(first), count, low, high, {}};
    shades.scale.stands_for[kNoMaterial] = true;
    for (int n = 0; n < shown.material_size(); ++n)
        shades.scale.stands_for[size_t(n) + 1] = isShaded(shown.material(n));
    for (int n = 0; n < count; ++n)
        shades.list.push_back(shadeAt(
            anchors, anchors.front().raw + (anchors.back().raw - anchors.front().raw) * n / (count - 1)));
    return shades;
}

void describeShades(const ShownShades& shades, topics::SceneInfo& info) {
    for (const scene::Material& shade : shades.list) *info.add_materials() = shade;
}

ShownBone::ShownBone(const scene::Scene& scene, const SceneSetup& simulation, const VoxelVolume& scanned)
    : scanned_(scanned), materials_(simulation.tick.effects.materials) {
    const scene::Scene shown = shownSceneOf(scene, simulation.segment_colors);
    if (!wantsVertexMaterials(shown)) return;
    properties_ = simulation.tick.effects.properties.get();
    const ShadeScale scale = shadesOf(shown, simulation.mapping).scale;
    if (scale.count == 0) return;
    const Surroundings* const around = simulation.surroundings.get();
    const VoxelVolume& volume = simulation.bone->volume;
    if (around)
        shade_.emplace(scale, around->volume.geometry(), around->X_VS.inverse(), volume.iso(),
                       densitiesOf(around->volume));
    else
        shade_.emplace(
            scale, volume.geometry(), Pose{}, volume.iso(),
            [properties = properties_](const Eigen::Vector3i& v) { return properties->original(v); });
}

}  // namespace bonemill
