#include "haptic_server/server/session/shown_effects.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "common/base/units.h"
#include "common/config/shown_colours.h"
#include "common/config/viewer_effects.h"
#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

constexpr double kMaxShown = 1e6;  // viewers refuse larger numbers

// The name comes from another process, and messages hold UTF-8.
std::string readableName(const char* name) {
    std::string shown;
    for (const char* c = name; *c != 0; ++c) shown += *c >= ' ' && *c <= '~' ? *c : '?';
    return shown;
}

bool areEverShown(const scene::Task& task) {
    return !task.exam() && task.feedback() != scene::Task::NEVER;
}

// A context has no colour unless the scene gives it one.
bool hasColour(const scene::Task::Zone& zone) {
    return zone.has_color() || zone.role() != scene::Task::CONTEXT;
}

scene::Color colourOf(const scene::Task::Zone& zone) {
    if (zone.has_color()) return zone.color();
    const auto* const found = std::ranges::find(kZoneColours, zone.role(), &ZoneColour::role);
    const Srgb& of = found == std::end(kZoneColours) ? kOtherZone : found->colour;
    scene::Color colour;
    colour.set_red(of[0]), colour.set_green(of[1]), colour.set_blue(of[2]);
    return colour;
}

constexpr size_t kMaxWarnings = 32;  // in a status

// The tick's bits go out as they are.
static_assert(int(kEventSpindleStalled) == topics::EffectState::SPINDLE_STALLED);
static_assert(int(kEventNearProtected) == topics::EffectState::NEAR_PROTECTED);
static_assert(int(kEventProtectedTouched) == topics::EffectState::PROTECTED_TOUCHED);
static_assert(int(kEventProtectedDamaged) == topics::EffectState::PROTECTED_DAMAGED);
static_assert(int(kEventTooHot) == topics::EffectState::TOO_HOT);

// A client drops a state with a number that is none.
double finite(float value) {
    return std::isfinite(value) ? double(value) : 0;
}

// Returns those that are the viewer's alone.
scene::Effects viewerEffectsOf(scene::Effects effects) {
    keepViewerEffects(effects);
    return effects;
}

bool isAnyListed(const scene::Effects& effects) {
    return effects.ByteSizeLong() > 0;
}

}  // namespace

topics::Device shownDevice(const TickRecord& record, const DeviceCapabilities* capabilities) {
    const DeviceReport& report = record.device;
    topics::Device device;
    device.set_state(report.state);
    device.set_stop_cause(report.stop_cause);
    device.set_fault_code(report.fault_code);
    device.set_is_simulated(report.flags & kDeviceFlagSimulated);
    device.set_is_force_limited(report.flags & kDeviceFlagForceLimited);
    device.set_is_enabled(report.flags & kDeviceFlagEnabled);
    device.set_force_waits(report.flags & kDeviceFlagForceWaits);
    device.set_coupling_share(record.coupling_share);
    device.set_rotation_share(record.rotation_share);
    if (!capabilities) return device;
    device.set_name(readableName(capabilities->name));
    device.set_kind(capabilities->kind);
    device.set_abilities(capabilities->abilities);
    device.set_max_force_n(std::min(capabilities->max_force, kMaxShown));
    device.set_max_torque_nmm(std::min(capabilities->max_torque * kPerMilli, kMaxShown));
    return device;
}

std::string deviceText(const DeviceCapabilities& capabilities) {
    const auto most = [](bool is_able, double value, const char* unit, const char* none) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g %s", value, unit);
        return std::string(is_able && value > 0 ? text : none);
    };
    return readableName(capabilities.name) + ": " +
           most(capabilities.abilities & kAbilityForce, capabilities.max_force, "N", "no force") + ", " +
           most(capabilities.abilities & kAbilityTorque, capabilities.max_torque * kPerMilli, "N·mm",
                "no torque");
}

int shownZones(const scene::Scene& scene) {
    return areEverShown(scene.assessment()) ? scene.assessment().zone_size() : 0;
}

void describeZones(const scene::Scene& scene, topics::SceneInfo& info) {
    if (shownZones(scene) == 0) return;
    for (const scene::Task::Zone& zone : scene.assessment().zone()) {
        scene::Material& shown = *info.add_materials();
        shown.set_name(zone.name());
        if (hasColour(zone)) *shown.mutable_color() = colourOf(zone);
    }
}

std::optional<ZonePaint> zonePaintOf(const scene::Scene& scene, const JudgedTask* task,
                                     const VoxelVolume& scanned) {
    if (task == nullptr || task->zones.empty() || !areEverShown(scene.assessment())) return std::nullopt;
    ZonePaint paint;
    paint.zones = task->map;
    paint.scanned = &scanned;
    for (int n = 0; n < scene.assessment().zone_size(); ++n) {
        const scene::Task::Zone& zone = scene.assessment().zone(n);
        if (!hasColour(zone)) continue;
        const auto id = uint8_t(scene.material_size() + n + 1);
        (zone.role() == scene::Task::TARGET ? paint.when_left : paint.when_gone)[size_t(n) + 1] = id;
    }
    return paint;
}

void describeToViewers(const scene::Scene& scene, topics::SceneInfo& info) {
    const scene::Effects effects = viewerEffectsOf(scene.effects());
    if (isAnyListed(effects)) *info.mutable_viewer_effects() = effects;
    for (const scene::Material& material : scene.material()) {
        scene::Material& shown = *info.add_materials();
        shown.set_name(material.name());
        if (material.has_color()) *shown.mutable_color() = material.color();
        if (material.is_protected()) shown.set_is_protected(true);
    }
}

void describeBurr(const scene::Scene& scene, const Burr& burr, topics::SceneInfo& info) {
    info.clear_burr_balls_m();
    if (std::ranges::none_of(scene.material(), [](const auto& m) { return m.is_protected(); })) return;
    for (const BurrProbe& probe : BurrProbes(burr)) {
        for (const double coordinate : probe.center_T) info.add_burr_balls_m(float(coordinate));
        info.add_burr_balls_m(float(probe.radius));
    }
}

double warningDistanceOf(const scene::Effects& effects) {
    const bool is_fixture_only = effects.has_virtual_fixture() && !effects.has_protected_structures();
    return (is_fixture_only ? effects.virtual_fixture().distance_mm()
                            : effects.protected_structures().warning_distance_mm()) *
           kMillimetre;
}

void addLines(std::span<const EffectFigure> figures, const EffectRecord& newest,
              const RecordedEffects& recorded, topics::EffectState& state) {
    for (const EffectFigure& figure : figures) {
        if (!figure.shown.line || !figure.isToldBy(recorded)) continue;
        const double value = figure.shown.factor * figure.numberIn(newest);
        if (!std::isfinite(value)) continue;
        topics::ShownFigure& shown = *state.add_figures();
        shown.set_words(figure.shown.line);
        shown.set_value(value);
        shown.set_unit(figure.shown.unit);
    }
}

ShownEffects::ShownEffects(const scene::Effects& effects)
    : recorded_(recordedEffectsOf(effects)), is_seen_(isAnyListed(viewerEffectsOf(effects))) {}

topics::EffectState ShownEffects::at(const EffectRecord& newest, const EventSum& events,
                                     double removed) const {
    topics::EffectState state;
    state.set_events(events.events);
    state.set_removed_mm3(removed * kPerCubicMillimetre);
    if (recorded_.burr || is_seen_) state.set_spin_speed(finite(newest.spin_speed));
    if (recorded_.burr) {
        state.set_burr_force_n(finite(newest.burr_force));
        state.set_axis_torque_nm(finite(newest.axis_torque));
        state.set_cutting_power_w(finite(newest.cutting_power));
    }
    if (recorded_.heat) {
        state.set_temperature_c(finite(newest.temperature));
        state.set_necrotic_mm3(finite(newest.necrotic_volume) * kPerCubicMillimetre);
    }
    addLines(kEffectFigures, newest, recorded_, state);
    if (!recorded_.protection) return state;
    state.set_protected_force_n(finite(newest.protected_force));
    state.set_damaged_mm3(finite(newest.damaged_volume) * kPerCubicMillimetre);
    state.set_event_id(events.structure);
    if (newest.protected_id == 0 || !std::isfinite(newest.protected_distance)) return state;
    state.set_protected_id(newest.protected_id);
    state.set_protected_distance_m(double(newest.protected_distance));
    return state;
}

void ShownEffects::describe(const EffectStatistics& statistics, const std::vector<std::string>& materials,
                            topics::Status& status) const {
    if (hasTraining()) fill(statistics, materials, *status.mutable_training());
}

void ShownEffects::describe(const EffectStatistics& statistics, const std::vector<std::string>& materials,
                            topics::Attempt& attempt) const {
    if (hasTraining()) fill(statistics, materials, *attempt.mutable_training());
    constexpr size_t kMaxStructures = 64;  // a viewer takes no more
    for (std::string& name : statistics.touched(materials))
        if (size_t(attempt.structures_touched_size()) < kMaxStructures)
            attempt.add_structures_touched(std::move(name));
}

void ShownEffects::fill(const EffectStatistics& statistics, const std::vector<std::string>& materials,
                        topics::Training& training) const {
    if (recorded_.protection) {
        training.set_damaged_mm3(statistics.figure("protected_damaged_mm3").value());
        training.set_max_protected_force_n(statistics.figure("protected_force_max_n").value());
        if (const auto distance = statistics.figure("protected_distance_min_mm"))
            training.set_least_distance_mm(*distance);
        training.set_nearest_structure(statistics.nearest(materials));
    }
    if (recorded_.heat) {
        training.set_necrotic_mm3(statistics.figure("necrotic_mm3").value());
        if (const auto temperature = statistics.figure("temperature_max_c"))
            training.set_max_temperature_c(*temperature);
    }
    std::vector<std::string> warnings = statistics.warnings(materials);
    if (warnings.size() > kMaxWarnings) {
        const size_t more = warnings.size() - (kMaxWarnings - 1);
        warnings.resize(kMaxWarnings - 1);
        warnings.push_back("and " + std::to_string(more) + " more");
    }
    for (std::string& warning : warnings) training.add_warnings(std::move(warning));
}

}  // namespace bonemill
