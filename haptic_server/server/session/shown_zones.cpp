#include "haptic_server/server/session/shown_zones.h"

namespace bonemill {
namespace {

bool areEverShown(const scene::Task& task) {
    return !task.exam() && task.feedback() != scene::Task::NEVER;
}

// A context has no colour unless the scene gives it one.
bool hasColour(const scene::Task::Zone& zone) {
    return zone.has_color() || zone.role() != scene::Task::CONTEXT;
}

scene::Color colourOf(const scene::Task::Zone& zone) {
    if (zone.has_color()) return zone.color();
    scene::Color colour;
    const auto set = [&](double red, double green, double blue) {
        colour.set_red(red), colour.set_green(green), colour.set_blue(blue);
    };
    switch (zone.role()) {
        case scene::Task::TARGET:
            set(0.30, 0.72, 0.35);
            break;
        case scene::Task::LEEWAY_SIDES:
            set(0.95, 0.85, 0.25);
            break;
        case scene::Task::LEEWAY_BOTTOM:
            set(0.95, 0.65, 0.15);
            break;
        case scene::Task::CONTAINER_SIDES:
            set(0.90, 0.35, 0.15);
            break;
        case scene::Task::CONTAINER_BOTTOM:
            set(0.80, 0.12, 0.12);
            break;
        default:
            set(0.75, 0.20, 0.65);
            break;
    }
    return colour;
}

}  // namespace

void describeZones(const scene::Scene& scene, topics::SceneInfo& info) {
    if (!areEverShown(scene.assessment())) return;
    for (const scene::Task::Zone& zone : scene.assessment().zone()) {
        scene::Material& shown = *info.add_materials();
        shown.set_name(zone.name());
        if (hasColour(zone)) *shown.mutable_color() = colourOf(zone);
    }
}

std::optional<ZonePaint> zonePaintOf(const scene::Scene& scene, const JudgedTask* task,
                                     const VoxelVolume& scanned) {
    if (task == nullptr || task->zones.empty() || !areEverShown(scene.assessment())) return std::nullopt;
    ZonePaint paint{.zones = task->map, .scanned = &scanned};
    for (int n = 0; n < scene.assessment().zone_size(); ++n) {
        const scene::Task::Zone& zone = scene.assessment().zone(n);
        if (!hasColour(zone)) continue;
        const auto id = uint8_t(scene.material_size() + n + 1);
        (zone.role() == scene::Task::TARGET ? paint.when_left : paint.when_gone)[size_t(n) + 1] = id;
    }
    return paint;
}

}  // namespace bonemill
