#include "render_client/look/hud/effect_lines.h"

#include <cmath>

#include "common/base/units.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

using topics::EffectState;

constexpr size_t kLongestStructureName = 16;
// Above this temperature bone is warm to worry about: 42 °C is where heat stress of cells is seen; 47 °C for
// a minute kills bone (Eriksson and Albrektsson 1983).
constexpr double kWarm_c = 42;
constexpr uint32_t kHarm = EffectState::PROTECTED_TOUCHED | EffectState::PROTECTED_DAMAGED;

HudTone toneOfVolume(double mm3) {
    return mm3 > 0 ? HudTone::kAlarm : HudTone::kGood;
}

std::string volumeText(double mm3) {
    return mm3 > 0 ? readableText(mm3, " mm\u00b3") : "none";
}

HudRow temperatureRow(double celsius, uint32_t events) {
    const HudTone tone = events & EffectState::TOO_HOT ? HudTone::kAlarm
                         : celsius >= kWarm_c          ? HudTone::kWarning
                                                       : HudTone::kPlain;
    return {"Hottest bone", figureText(celsius, 1, " \u00b0C"), tone};
}

// A negative distance means that the burr is in the structure. The row stands where nothing is near, too.
HudRow structureRow(const EffectState& state, const topics::SceneInfo* info, uint32_t events) {
    if (!state.has_protected_distance_m()) return {"Protected", "far"};
    const double distance_mm = state.protected_distance_m() * kPerMillimetre;
    const HudTone tone = events & kHarm || distance_mm <= 0     ? HudTone::kAlarm
                         : events & EffectState::NEAR_PROTECTED ? HudTone::kWarning
                                                                : HudTone::kPlain;
    return {shortenedText(structureName(state.protected_id(), info), kLongestStructureName),
            distance_mm <= 0 ? "touched" : readableText(distance_mm, " mm"), tone};
}

}  // namespace

std::string structureName(uint32_t protected_id, const topics::SceneInfo* info) {
    if (!info || protected_id == 0 || protected_id > uint32_t(info->materials_size())) return "protected";
    const std::string& name = info->materials(int(protected_id) - 1).name();
    return name.empty() ? "material " + std::to_string(protected_id) : name;
}

std::vector<HudRow> effectTaskRows(const EffectState& state, const topics::SceneInfo* info, uint32_t events) {
    std::vector<HudRow> rows;
    if (state.has_protected_distance_m() || state.has_damaged_mm3())
        rows.push_back(structureRow(state, info, events));
    if (state.has_damaged_mm3())
        rows.push_back({"Damaged", volumeText(state.damaged_mm3()), toneOfVolume(state.damaged_mm3())});
    if (state.has_temperature_c()) rows.push_back(temperatureRow(state.temperature_c(), events));
    if (state.has_necrotic_mm3())
        rows.push_back({"Necrosis", volumeText(state.necrotic_mm3()), toneOfVolume(state.necrotic_mm3())});
    for (const topics::ShownFigure& figure : state.figures())
        rows.push_back({shortenedText(figure.words(), kLongestStructureName),
                        readableText(figure.value(), (" " + figure.unit()).c_str())});
    return rows;
}

std::vector<HudRow> effectDetailRows(const EffectState& state) {
    std::vector<HudRow> rows;
    if (state.has_spin_speed()) rows.push_back({"Spindle", figureText(state.spin_speed() / kRpm, 0, " rpm")});
    if (state.has_axis_torque_nm())
        rows.push_back({"Load", readableText(state.axis_torque_nm() * kPerMilli, " N\u00b7mm")});
    if (state.has_cutting_power_w()) rows.push_back({"Cutting", readableText(state.cutting_power_w(), " W")});
    return rows;
}

std::optional<HudNotice> effectAlert(uint32_t events, uint32_t structure, const topics::SceneInfo* info) {
    const std::string name = structureName(structure, info);
    HudNotice alert;
    if (events & EffectState::PROTECTED_DAMAGED) {
        alert = {"Damages " + name, HudTone::kAlarm};
    } else if (events & EffectState::PROTECTED_TOUCHED) {
        alert = {"Touches " + name, HudTone::kAlarm};
    } else if (events & EffectState::NEAR_PROTECTED) {
        alert = {"Near " + name, HudTone::kWarning};
    }
    if (events & EffectState::TOO_HOT)
        alert = {alert.text.empty() ? "Bone too hot" : alert.text + ", bone too hot", HudTone::kAlarm};
    return alert.text.empty() ? std::nullopt : std::optional(alert);
}

std::vector<HudRow> trainingRows(const topics::Training& training) {
    std::vector<HudRow> rows;
    if (training.has_damaged_mm3())
        rows.push_back({"Damaged", volumeText(training.damaged_mm3()), toneOfVolume(training.damaged_mm3())});
    if (training.has_least_distance_mm())
        rows.push_back(
            {"Least distance to " + (training.nearest_structure().empty() ? "a protected structure"
                                                                          : training.nearest_structure()),
             readableText(training.least_distance_mm(), " mm"),
             training.least_distance_mm() <= 0 ? HudTone::kAlarm : HudTone::kPlain});
    if (training.has_max_protected_force_n())
        rows.push_back(
            {"Largest force on a protected structure", readableText(training.max_protected_force_n(), " N")});
    if (training.has_necrotic_mm3())
        rows.push_back(
            {"Necrosis", volumeText(training.necrotic_mm3()), toneOfVolume(training.necrotic_mm3())});
    if (training.has_max_temperature_c())
        rows.push_back({"Hottest bone so far", figureText(training.max_temperature_c(), 1, " \u00b0C"),
                        training.max_temperature_c() >= kWarm_c ? HudTone::kWarning : HudTone::kPlain});
    for (const std::string& warning : training.warnings()) rows.push_back({"", warning, HudTone::kWarning});
    return rows;
}

}  // namespace bonemill
