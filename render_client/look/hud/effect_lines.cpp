#include "render_client/look/hud/effect_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr double kLittleTime = 60;  // s
constexpr int kMaxNamedGates = 2;

struct RoleRow {
    scene::Task::Role role;
    const char* label;
    bool in_percent;
};
// What is left of targets counts by its share, what is gone of the others by its volume.
constexpr RoleRow kRoleRows[] = {{scene::Task::TARGET, trMark("Target"), true},
                                 {scene::Task::LEEWAY_SIDES, trMark("Leeway, sides"), false},
                                 {scene::Task::LEEWAY_BOTTOM, trMark("Leeway, bottom"), false},
                                 {scene::Task::CONTAINER_SIDES, trMark("Beyond, sides"), false},
                                 {scene::Task::CONTAINER_BOTTOM, trMark("Beyond, bottom"), false}};

// What is gone of all zones of a role; empty if there are none.
std::string goneText(const topics::TaskState& task, const RoleRow& row) {
    double removed = 0, bone = 0;
    bool is_there = false;
    for (const topics::TaskState::Zone& zone : task.zones()) {
        if (zone.role() != uint32_t(row.role)) continue;
        is_there = true;
        removed += zone.removed_mm3();
        bone += zone.bone_mm3();
    }
    if (!is_there) return {};
    if (row.in_percent) return figureText(bone > 0 ? 100 * removed / bone : 0, 0, " %");
    return readableText(removed, " mm\u00b3");
}

void addZoneRow(const topics::TaskState& task, const RoleRow& row, std::vector<HudRow>& rows) {
    if (std::string gone = goneText(task, row); !gone.empty())
        rows.push_back({tr(row.label), std::move(gone)});
}

int countOf(const topics::TaskState& task, topics::TaskState::Gate::State state) {
    return int(std::ranges::count_if(task.gates(), [&](const auto& gate) { return gate.state() == state; }));
}

// While the task is done it is one line, whatever happens.
HudRow gateRow(const topics::TaskState& task) {
    using Gate = topics::TaskState::Gate;
    const std::string all = std::to_string(task.gates_size());
    if (const int broken = countOf(task, Gate::BROKEN))
        return {tr("Limits"), tr("{1} of {2} broken", {std::to_string(broken), all}), HudTone::kAlarm};
    if (const int open = countOf(task, Gate::OPEN))
        return {tr("Limits"), tr("{1} of {2} open", {std::to_string(open), all})};
    return {tr("Limits"), tr("all held"), HudTone::kGood};
}

void addResultRows(const topics::TaskState& task, std::vector<HudRow>& rows) {
    const int broken = countOf(task, topics::TaskState::Gate::BROKEN);
    rows.push_back({tr("Result"), broken == 0 ? tr("passed") : tr("failed"),
                    broken == 0 ? HudTone::kGood : HudTone::kAlarm});
    int named = 0;
    for (const topics::TaskState::Gate& gate : task.gates()) {
        if (gate.state() != topics::TaskState::Gate::BROKEN || named++ >= kMaxNamedGates) continue;
        for (std::string& line : wrappedText(gate.text(), kLongestRow))
            rows.push_back({std::move(line), "", HudTone::kAlarm});
    }
    if (broken > kMaxNamedGates)
        rows.push_back({tr("and {1} more", {std::to_string(broken - kMaxNamedGates)}), "", HudTone::kAlarm});
}

std::string timeLeftText(const topics::TaskState& task) {
    return clockText(std::max(0.0, task.time_left_s()));
}

using topics::EffectState;

constexpr size_t kLongestStructureName = 16;
// Above this temperature bone is warm to worry about: 42 °C is where heat stress of cells is seen; 47 °C for
// a minute kills bone (Eriksson and Albrektsson 1983).
constexpr double kWarm_c = 42;
constexpr uint32_t kHarm = EffectState::PROTECTED_TOUCHED | EffectState::PROTECTED_DAMAGED;

HudRow harmRow(const char* label, double mm3) {
    if (mm3 > 0) return {tr(label), readableText(mm3, " mm\u00b3"), HudTone::kAlarm};
    return {tr(label), trIn("volume", "none"), HudTone::kGood};
}

HudRow temperatureRow(double celsius, uint32_t events) {
    const HudTone tone = events & EffectState::TOO_HOT ? HudTone::kAlarm
                         : celsius >= kWarm_c          ? HudTone::kWarning
                                                       : HudTone::kPlain;
    return {tr("Hottest bone"), figureText(celsius, 1, " \u00b0C"), tone};
}

// A negative distance means that the burr is in the structure. The row stands where nothing is near, too.
HudRow structureRow(const EffectState& state, const topics::SceneInfo* info, uint32_t events) {
    if (!state.has_protected_distance_m()) return {tr("Protected"), tr("far")};
    const double distance_mm = state.protected_distance_m() * kPerMillimetre;
    const HudTone tone = events & kHarm || distance_mm <= 0     ? HudTone::kAlarm
                         : events & EffectState::NEAR_PROTECTED ? HudTone::kWarning
                                                                : HudTone::kPlain;
    return {shortenedText(structureName(state.protected_id(), info), kLongestStructureName),
            distance_mm <= 0 ? tr("touched") : readableText(distance_mm, " mm"), tone};
}

}  // namespace

HudRow taskSummaryRow(const topics::TaskState& task) {
    const bool is_broken = countOf(task, topics::TaskState::Gate::BROKEN) > 0;
    std::string text =
        task.is_result() ? (is_broken ? tr("failed") : tr("passed")) : goneText(task, kRoleRows[0]);
    if (task.has_time_left_s()) text += (text.empty() ? "" : ", ") + timeLeftText(task);
    return {tr("Task"), text, is_broken ? HudTone::kAlarm : HudTone::kPlain};
}

std::vector<HudRow> taskStateRows(const topics::TaskState& task) {
    std::vector<HudRow> rows;
    if (task.has_time_left_s())
        rows.push_back({tr("Time left"), timeLeftText(task),
                        task.time_left_s() < kLittleTime ? HudTone::kWarning : HudTone::kPlain});
    for (const RoleRow& row : kRoleRows) addZoneRow(task, row, rows);
    if (task.gates_size() > 0 && task.is_result())
        addResultRows(task, rows);
    else if (task.gates_size() > 0)
        rows.push_back(gateRow(task));
    if (task.has_score())
        rows.push_back({tr("Score"), tr("{1} of 100", {figureText(100 * task.score(), 0, "")})});
    return rows;
}

std::string structureName(uint32_t protected_id, const topics::SceneInfo* info) {
    if (!info || protected_id == 0 || protected_id > uint32_t(info->materials_size())) return tr("protected");
    const std::string& name = info->materials(int(protected_id) - 1).name();
    return name.empty() ? tr("material {1}", {std::to_string(protected_id)}) : name;
}

std::vector<HudRow> effectTaskRows(const EffectState& state, const topics::SceneInfo* info, uint32_t events) {
    std::vector<HudRow> rows;
    if (state.has_protected_distance_m() || state.has_damaged_mm3())
        rows.push_back(structureRow(state, info, events));
    if (state.has_damaged_mm3()) rows.push_back(harmRow(trMark("Damaged"), state.damaged_mm3()));
    if (state.has_temperature_c()) rows.push_back(temperatureRow(state.temperature_c(), events));
    if (state.has_necrotic_mm3()) rows.push_back(harmRow(trMark("Necrosis"), state.necrotic_mm3()));
    for (const topics::ShownFigure& figure : state.figures())
        rows.push_back({shortenedText(figure.words(), kLongestStructureName),
                        readableText(figure.value(), (" " + figure.unit()).c_str())});
    return rows;
}

std::vector<HudRow> effectDetailRows(const EffectState& state) {
    std::vector<HudRow> rows;
    if (state.has_spin_speed())
        rows.push_back({tr("Spindle"), tr("{1} rpm", {figureText(state.spin_speed() / kRpm, 0, "")})});
    if (state.has_axis_torque_nm())
        rows.push_back({tr("Load"), readableText(state.axis_torque_nm() * kPerMilli, " N\u00b7mm")});
    if (state.has_cutting_power_w())
        rows.push_back({tr("Cutting"), readableText(state.cutting_power_w(), " W")});
    return rows;
}

std::optional<HudNotice> effectAlert(uint32_t events, uint32_t structure, const topics::SceneInfo* info) {
    const std::string name = structureName(structure, info);
    HudNotice alert;
    if (events & EffectState::PROTECTED_DAMAGED) {
        alert = {tr("Damages {1}", {name}), HudTone::kAlarm};
    } else if (events & EffectState::PROTECTED_TOUCHED) {
        alert = {tr("Touches {1}", {name}), HudTone::kAlarm};
    } else if (events & EffectState::NEAR_PROTECTED) {
        alert = {tr("Near {1}", {name}), HudTone::kWarning};
    }
    if (events & EffectState::TOO_HOT)
        alert = {alert.text.empty() ? tr("Bone too hot") : tr("{1}, bone too hot", {alert.text}),
                 HudTone::kAlarm};
    return alert.text.empty() ? std::nullopt : std::optional(alert);
}

std::vector<HudRow> trainingRows(const topics::Training& training) {
    std::vector<HudRow> rows;
    if (training.has_damaged_mm3()) rows.push_back(harmRow(trMark("Damaged"), training.damaged_mm3()));
    if (training.has_least_distance_mm())
        rows.push_back({training.nearest_structure().empty()
                            ? tr("Least distance to a protected structure")
                            : tr("Least distance to {1}", {training.nearest_structure()}),
                        readableText(training.least_distance_mm(), " mm"),
                        training.least_distance_mm() <= 0 ? HudTone::kAlarm : HudTone::kPlain});
    if (training.has_max_protected_force_n())
        rows.push_back({tr("Largest force on a protected structure"),
                        readableText(training.max_protected_force_n(), " N")});
    if (training.has_necrotic_mm3()) rows.push_back(harmRow(trMark("Necrosis"), training.necrotic_mm3()));
    if (training.has_max_temperature_c())
        rows.push_back({tr("Hottest bone so far"), figureText(training.max_temperature_c(), 1, " \u00b0C"),
                        training.max_temperature_c() >= kWarm_c ? HudTone::kWarning : HudTone::kPlain});
    for (const std::string& warning : training.warnings()) rows.push_back({"", warning, HudTone::kWarning});
    return rows;
}

}  // namespace bonemill
