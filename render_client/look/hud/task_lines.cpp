#include "render_client/look/hud/task_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/session_text.h"

namespace bonemill {
namespace {

constexpr double kLittleTime = 60;  // s
constexpr int kMaxGateRows = 2;

struct RoleRow {
    scene::Task::Role role;
    const char* label;
    bool in_percent;
};
// What is left of targets counts by its share, what is gone of the others by its volume.
constexpr RoleRow kRoleRows[] = {{scene::Task::TARGET, "Target", true},
                                 {scene::Task::LEEWAY_SIDES, "Leeway, sides", false},
                                 {scene::Task::LEEWAY_BOTTOM, "Leeway, bottom", false},
                                 {scene::Task::CONTAINER_SIDES, "Beyond, sides", false},
                                 {scene::Task::CONTAINER_BOTTOM, "Beyond, bottom", false}};

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
    if (std::string gone = goneText(task, row); !gone.empty()) rows.push_back({row.label, std::move(gone)});
}

int countOf(const topics::TaskState& task, topics::TaskState::Gate::State state) {
    return int(std::ranges::count_if(task.gates(), [&](const auto& gate) { return gate.state() == state; }));
}

// While the task is done it is one line, whatever happens.
HudRow gateRow(const topics::TaskState& task) {
    using Gate = topics::TaskState::Gate;
    const std::string of_all = " of " + std::to_string(task.gates_size());
    if (const int broken = countOf(task, Gate::BROKEN))
        return {"Limits", std::to_string(broken) + of_all + " broken", HudTone::kAlarm};
    if (const int open = countOf(task, Gate::OPEN))
        return {"Limits", std::to_string(open) + of_all + " open"};
    return {"Limits", "all held", HudTone::kGood};
}

void addResultRows(const topics::TaskState& task, std::vector<HudRow>& rows) {
    const int broken = countOf(task, topics::TaskState::Gate::BROKEN);
    rows.push_back(
        {"Result", broken == 0 ? "passed" : "failed", broken == 0 ? HudTone::kGood : HudTone::kAlarm});
    int named = 0;
    for (const topics::TaskState::Gate& gate : task.gates())
        if (gate.state() == topics::TaskState::Gate::BROKEN && named++ < kMaxGateRows)
            rows.push_back({shortenedText(gate.text(), kLongestRow), "", HudTone::kAlarm});
    if (broken > kMaxGateRows)
        rows.push_back({"and " + std::to_string(broken - kMaxGateRows) + " more", "", HudTone::kAlarm});
}

std::string timeLeftText(const topics::TaskState& task) {
    return clockText(std::max(0.0, task.time_left_s()));
}

}  // namespace

HudRow taskSummaryRow(const topics::TaskState& task) {
    const bool is_broken = countOf(task, topics::TaskState::Gate::BROKEN) > 0;
    std::string text = task.is_result() ? (is_broken ? "failed" : "passed") : goneText(task, kRoleRows[0]);
    if (task.has_time_left_s()) text += (text.empty() ? "" : ", ") + timeLeftText(task);
    return {"Task", text, is_broken ? HudTone::kAlarm : HudTone::kPlain};
}

std::vector<HudRow> taskStateRows(const topics::TaskState& task) {
    std::vector<HudRow> rows;
    if (task.has_time_left_s())
        rows.push_back({"Time left", timeLeftText(task),
                        task.time_left_s() < kLittleTime ? HudTone::kWarning : HudTone::kPlain});
    for (const RoleRow& row : kRoleRows) addZoneRow(task, row, rows);
    if (task.gates_size() > 0 && task.is_result())
        addResultRows(task, rows);
    else if (task.gates_size() > 0)
        rows.push_back(gateRow(task));
    if (task.has_score()) rows.push_back({"Score", figureText(100 * task.score(), 0, " of 100")});
    return rows;
}

}  // namespace bonemill
