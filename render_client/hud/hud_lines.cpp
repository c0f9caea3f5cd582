#include "render_client/hud/hud_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/units.h"
#include "render_client/hud/burr_work.h"
#include "render_client/hud/device_lines.h"
#include "render_client/hud/effect_lines.h"
#include "render_client/hud/figure_text.h"
#include "render_client/hud/session_text.h"

namespace bonemill {
namespace {

constexpr size_t kLongestName = 24;
constexpr int kMostWatchers = 8;  // rows of the list

double norm(const google::protobuf::RepeatedField<double>& v) {
    return v.size() == 3 ? std::hypot(v[0], v[1], v[2]) : std::nan("");
}

void addSessionRows(const topics::Status& status, std::vector<HudRow>& rows) {
    if (status.ticks() > 0) rows.push_back({"Session", clockText(status.session_s())});
    if (status.is_milling_paused()) rows.push_back({"Milling", "paused", HudTone::kWarning});
}

void addToolNameRow(const topics::SceneInfo& info, std::vector<HudRow>& rows) {
    if (info.tool_names_size() < 2 || info.tool_index() >= uint32_t(info.tool_names_size())) return;
    rows.push_back({"Tool", shortenedText(info.tool_names(int(info.tool_index())), kLongestName)});
}

HudRow watcherRow(const topics::Viewer& watcher) {
    const std::string name = shortenedText(watcherName(watcher.name()), kLongestName);
    return {name, watcherText(watcher), watcher.is_complete() ? HudTone::kPlain : HudTone::kWarning};
}

std::vector<HudRow> watcherRows(const std::vector<topics::Viewer>& watchers) {
    const auto count = int(watchers.size());
    const int shown = count <= kMostWatchers ? count : kMostWatchers - 1;
    std::vector<HudRow> rows;
    for (int i = 0; i < shown; ++i) rows.push_back(watcherRow(watchers[size_t(i)]));
    if (shown < count) rows.push_back({"and " + std::to_string(count - shown) + " more", ""});
    return rows;
}

void addLoopRows(const topics::Status& status, std::vector<HudRow>& rows) {
    if (status.ticks() == 0) return rows.push_back({"Loop", "waits for a device", HudTone::kWarning});
    rows.push_back({"Loop", figureText(status.rate_hz(), 1, " Hz")});
    rows.push_back({"Tick p50 / p99", readableText(status.tick_p50_us(), "") + " / " +
                                          readableText(status.tick_p99_us(), " \u00b5s")});
}

void addAccuracyRows(const topics::Status& status, std::vector<HudRow>& rows) {
    // A preset is one word; all knobs take more than one line.
    std::string label = "Accuracy";
    for (const std::string& line : wrappedText(status.preset(), kLongestRow))
        rows.push_back({std::exchange(label, ""), line});
    rows.push_back({"Force error", status.has_accuracy_error()
                                       ? readableText(status.force_error_percent(), " %") + ", " +
                                             readableText(status.force_direction_error_deg(), "\u00b0")
                                       : "not measured"});
}

HudRow burrRow(BurrWork work) {
    switch (work) {
        case BurrWork::kRemoving:
            return {"Burr", "removing", HudTone::kWarning};
        case BurrWork::kAdding:
            return {"Burr", "adding", HudTone::kWarning};
        case BurrWork::kIdle:
            break;
    }
    return {"Burr", "idle"};
}

void addToolRows(const topics::ToolState& tool, std::vector<HudRow>& rows) {
    rows.push_back({"Force", readableText(norm(tool.force_n()), " N")});
    rows.push_back({"Torque", readableText(norm(tool.torque_nm()) * kPerMilli, " N\u00b7mm")});
    rows.push_back({"Contacts", std::to_string(tool.contacts())});
    rows.push_back(burrRow(burrWorkOf(tool)));
}

void addEffectRows(const HudInput& input, std::vector<HudRow>& rows) {
    const auto more = effectRows(input.tool->effects(), input.info ? &*input.info : nullptr, input.events);
    rows.insert(rows.end(), more.begin(), more.end());
}

void addDeviceRows(const HudInput& input, std::vector<HudRow>& rows) {
    const auto more = deviceRows(input.status->device(), input.tool ? &*input.tool : nullptr);
    rows.insert(rows.end(), more.begin(), more.end());
}

void addFaultRow(const topics::Status& status, std::vector<HudRow>& rows) {
    if (status.device_stale() && status.ticks() > 0)
        rows.push_back({"Device", "no fresh samples", HudTone::kAlarm});
    if (status.faults() == 0) return rows.push_back({"Faults", "none", HudTone::kGood});
    char code[16];
    std::snprintf(code, sizeof code, "0x%x", status.faults());
    rows.push_back({"Faults", status.fault_text().empty() ? code : status.fault_text(), HudTone::kAlarm});
}

std::string stateText(const HudInput& input) {
    switch (input.connection) {
        case Connection::kNoServer:
            return "waiting for a server";
        case Connection::kReceiving: {
            std::string text = "receiving " + std::to_string(input.node_count);
            if (input.status) text += " of " + std::to_string(input.status->node_count());
            return text + " nodes";
        }
        case Connection::kLive:
            return "live, " + std::to_string(input.node_count) + " nodes";
        case Connection::kServerLost:
            return "server lost";
    }
    return "";
}

HudTone stateTone(Connection connection) {
    switch (connection) {
        case Connection::kLive:
            return HudTone::kGood;
        case Connection::kReceiving:
        case Connection::kNoServer:
            return HudTone::kWarning;
        case Connection::kServerLost:
            return HudTone::kAlarm;
    }
    return HudTone::kPlain;
}

}  // namespace

std::optional<HudNotice> alertOf(const HudInput& input) {
    return effectAlert(input.events, input.structure, input.info ? &*input.info : nullptr);
}

Hud makeHud(const HudInput& input) {
    Hud hud;
    hud.title = input.info && !input.info->name().empty() ? input.info->name()
                : input.status                            ? input.status->scene()
                                                          : "bonemill";
    hud.state = stateText(input);
    hud.state_tone = stateTone(input.connection);
    hud.notice = input.notice;
    if (!input.show_help) hud.hint = input.hint;
    hud.alert = alertOf(input);
    if (input.status) {
        addSessionRows(*input.status, hud.rows);
        addLoopRows(*input.status, hud.rows);
        addAccuracyRows(*input.status, hud.rows);
    }
    if (input.info) addToolNameRow(*input.info, hud.rows);
    if (input.tool) addToolRows(*input.tool, hud.rows);
    if (input.tool && input.tool->has_effects()) addEffectRows(input, hud.rows);
    if (input.status) {
        hud.rows.push_back({"Removed", readableText(input.status->removed_mm3(), " mm\u00b3")});
        if (input.status->has_device()) addDeviceRows(input, hud.rows);
        addFaultRow(*input.status, hud.rows);
    }
    if (input.frame_rate_hz > 0) hud.rows.push_back({"Pictures", figureText(input.frame_rate_hz, 0, " Hz")});
    if (input.show_watchers) hud.watchers = watcherRows(input.watchers);
    if (input.show_help) hud.help = input.help;
    return hud;
}

}  // namespace bonemill
