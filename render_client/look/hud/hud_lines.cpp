#include "render_client/look/hud/hud_lines.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/conditions.h"
#include "render_client/look/hud/device_lines.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr size_t kMaxAccuracyLines = 2;

void append(std::vector<HudRow> more, std::vector<HudRow>& rows) {
    rows.insert(rows.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void addLoopRows(const topics::Status& status, std::vector<HudRow>& rows) {
    const bool has_ticked = status.ticks() > 0;
    rows.push_back({tr("Loop"), has_ticked ? figureText(status.rate_hz(), 1, " Hz") : kNoNumber});
    rows.push_back({tr("Tick p50 / p99"), has_ticked ? readableText(status.tick_p50_us(), "") + " / " +
                                                           readableText(status.tick_p99_us(), " \u00b5s")
                                                     : kNoNumber});
}

void addAccuracyRows(const topics::Status& status, std::vector<HudRow>& rows) {
    // A preset is one word; all knobs take more than one line.
    std::vector<std::string> lines = wrappedText(status.preset(), kLongestRow);
    if (lines.size() > kMaxAccuracyLines) {
        lines.resize(kMaxAccuracyLines);
        lines.back() += "\u2026";
    }
    std::string label = tr("Accuracy");
    for (const std::string& line : lines) rows.push_back({std::exchange(label, ""), line});
    rows.push_back({tr("Force error"), status.has_accuracy_error()
                                           ? readableText(status.force_error_percent(), " %") + ", " +
                                                 readableText(status.force_direction_error_deg(), "\u00b0")
                                           : tr("not measured")});
}

void addContactRows(const topics::ToolState& tool, std::vector<HudRow>& rows) {
    const auto& torque = tool.torque_nm();
    rows.push_back(
        {tr("Torque"), lengthText({torque.data(), size_t(torque.size())}, kPerMilli, " N\u00b7mm")});
    rows.push_back({tr("Contacts"), std::to_string(tool.contacts())});
}

HudRow faultRow(size_t count) {
    if (count == 0) return {tr("Faults"), trIn("faults", "none"), HudTone::kGood};
    return {tr("Faults"), tr("{1}, see the panel", {std::to_string(count)}), HudTone::kWarning};
}

// The lines that are folded as a rule: how well the session runs, and what of the force and the effects does
// not matter to the task.
std::vector<HudRow> detailRows(const HudInput& input) {
    std::vector<HudRow> rows;
    if (input.status) {
        addLoopRows(*input.status, rows);
        addAccuracyRows(*input.status, rows);
    }
    if (input.tool) {
        addContactRows(*input.tool, rows);
        append(effectDetailRows(input.tool->effects()), rows);
    }
    if (input.status && input.status->has_device())
        append(deviceRows(input.status->device(), input.tool ? &*input.tool : nullptr), rows);
    rows.push_back(faultRow(input.fault_count));
    rows.push_back({tr("Watching"), std::to_string(input.watchers.size())});
    if (input.frame_rate_hz > 0) rows.push_back({tr("Pictures"), figureText(input.frame_rate_hz, 0, " Hz")});
    return rows;
}

constexpr size_t kLongestName = 24;
constexpr int kMaxWatchers = 6;  // rows of the list

void addToolNameRow(const topics::SceneInfo& info, std::vector<HudRow>& rows) {
    if (info.tool_names_size() < 2 || info.tool_index() >= uint32_t(info.tool_names_size())) return;
    rows.push_back({tr("Tool"), shortenedText(info.tool_names(int(info.tool_index())), kLongestName)});
}

HudRow watcherRow(const topics::Viewer& watcher) {
    const std::string name = shortenedText(watcherName(watcher.name()), kLongestName);
    return {name, watcherText(watcher), watcher.is_complete() ? HudTone::kPlain : HudTone::kWarning};
}

std::vector<HudRow> watcherRows(const std::vector<topics::Viewer>& watchers) {
    const auto count = int(watchers.size());
    const int shown = count <= kMaxWatchers ? count : kMaxWatchers - 1;
    std::vector<HudRow> rows;
    for (int i = 0; i < shown; ++i) rows.push_back(watcherRow(watchers[size_t(i)]));
    if (shown < count) rows.push_back({tr("and {1} more", {std::to_string(count - shown)}), ""});
    return rows;
}

// The worst that keeps the burr from milling comes first.
HudRow burrRow(const topics::ToolState& tool, bool is_paused, uint32_t events) {
    if (events & topics::EffectState::SPINDLE_STALLED) return {tr("Burr"), tr("stalled"), HudTone::kAlarm};
    if (is_paused) return {tr("Burr"), tr("paused"), HudTone::kWarning};
    if (tool.waits_for_release() && tool.buttons() != 0)
        return {tr("Burr"), tr("release the pedal"), HudTone::kWarning};
    switch (burrWorkOf(tool)) {
        case BurrWork::kRemoving:
            return {tr("Burr"), tr("removing"), HudTone::kWarning};
        case BurrWork::kTurning:
            return {tr("Burr"), tr("turning")};
        case BurrWork::kAdding:
            return {tr("Burr"), tr("adding"), HudTone::kWarning};
        case BurrWork::kIdle:
            break;
    }
    return {tr("Burr"), tr("idle")};
}

HudRow volumeRow(double removed_mm3) {
    return {removed_mm3 < 0 ? tr("Added") : tr("Removed"), readableText(std::abs(removed_mm3), " mm\u00b3")};
}

HudRow comparisonRow(const topics::Comparison& comparison) {
    if (!comparison.problem().empty()) return {tr("Other"), tr("none, see panel"), HudTone::kWarning};
    return {tr("Other"), comparison.is_on_its_way() ? tr("on its way") : clockText(comparison.attempt_s()),
            HudTone::kPlain};
}

std::vector<HudRow> taskRows(const HudInput& input) {
    std::vector<HudRow> rows;
    const topics::SceneInfo* const info = input.info ? &*input.info : nullptr;
    if (info) addToolNameRow(*info, rows);
    if (input.tool) {
        const auto& force = input.tool->force_n();
        rows.push_back({tr("Force"), lengthText({force.data(), size_t(force.size())}, 1, " N")});
        rows.push_back(burrRow(*input.tool, input.status && input.status->is_milling_paused(), input.events));
    }
    const topics::TaskState* const task =
        input.status && input.status->has_task() ? &input.status->task() : nullptr;
    // With all figures there is room for one line of it, instead of what is removed in all.
    const bool is_summary = task && input.show_details;
    if (is_summary)
        rows.push_back(taskSummaryRow(*task));
    else if (input.status)
        rows.push_back(volumeRow(input.status->removed_mm3()));
    if (input.status && !input.status->replay().event().empty())
        rows.push_back({tr("Moment"), input.status->replay().event(), HudTone::kGood});
    if (input.status && input.status->replay().has_comparison())
        rows.push_back(comparisonRow(input.status->replay().comparison()));
    if (input.tool && input.tool->has_effects())
        append(effectTaskRows(input.tool->effects(), info, input.events), rows);
    if (task && !is_summary) append(taskStateRows(*task), rows);
    return rows;
}

std::string replayText(const topics::Status& status) {
    const topics::Replay& replay = status.replay();
    const std::string text = tr("replay, {1}", {clockText(status.session_s())});
    if (replay.is_seeking()) return tr("{1}, seeks", {text});
    if (!replay.is_playing()) return tr("{1}, paused", {text});
    return replay.speed() == 1 ? text : text + ", " + readableText(replay.speed(), " \u00d7");
}

std::string liveText(const HudInput& input) {
    if (!input.status) return tr("live");
    if (input.status->has_replay()) return replayText(*input.status);
    return input.status->ticks() > 0 ? tr("live, {1}", {clockText(input.status->session_s())})
                                     : tr("waits for a device");
}

std::string stateText(const HudInput& input) {
    switch (input.connection) {
        case Connection::kNoServer:
            return tr("waiting for a server");
        case Connection::kReceiving: {
            if (!input.status || input.status->node_count() == 0) return tr("loading");
            const uint64_t percent = 100 * uint64_t(input.node_count) / input.status->node_count();
            return tr("loading {1} %", {std::to_string(std::min<uint64_t>(percent, 100))});
        }
        case Connection::kLive:
            return liveText(input);
        case Connection::kServerLost:
            return tr("server lost");
        case Connection::kServerEnded:
            return tr("ended");
    }
    return "";
}

// Live is only as good as what stands in its way now.
HudTone liveTone(const HudInput& input) {
    HudTone tone = input.status && input.status->ticks() == 0 ? HudTone::kWarning : HudTone::kGood;
    for (const Condition& condition : conditionsOf(input))
        if (condition.lasts) tone = std::max(tone, condition.tone);
    return tone;
}

HudTone stateTone(const HudInput& input) {
    switch (input.connection) {
        case Connection::kLive:
            return liveTone(input);
        case Connection::kReceiving:
        case Connection::kNoServer:
            return HudTone::kWarning;
        case Connection::kServerLost:
            return HudTone::kAlarm;
        case Connection::kServerEnded:
            break;
    }
    return HudTone::kPlain;
}

std::string shownTitle(const HudInput& input) {
    if (input.info && !input.info->title().empty()) return input.info->title();
    if (input.info && !input.info->name().empty()) return input.info->name();
    return input.status ? input.status->scene() : "bonemill";
}

void removeFigures(Hud& hud) {
    hud.title.clear();
    hud.rows.clear();
    hud.details.clear();
    hud.watchers.clear();
    hud.modes.clear();
}

}  // namespace

HudPage waitingPage(const ServerSought& sought) {
    if (!sought.gateway.empty())
        return {tr("Waiting for a haptic_server"),
                {{tr("Gateway"), sought.gateway}},
                {tr("The gateway hears no server. Whoever started it knows of which session it is.")}};
    HudPage page{tr("Waiting for a haptic_server"),
                 {{tr("Session"),
                   sought.is_any_session ? tr("the only one there is") : std::to_string(sought.session)},
                  {tr("Domain"), std::to_string(sought.domain)},
                  {tr("Profile"), sought.profile}},
                 {tr("Is one running? deploy/bonemill start begins a session."),
                  tr("It must have been started with the same --session, --domain and --profile.")}};
    if (!sought.is_on_lan) {
        page.lines.push_back(tr("One on another PC is found with --profile lab or classroom only."));
        return page;
    }
    page.rows.push_back(
        {tr("Interface"), sought.interface.empty() ? tr("chosen by itself") : sought.interface});
    page.lines.push_back(tr("deploy/check-network says what is wrong between two PCs."));
    return page;
}

std::optional<HudNotice> alertOf(const HudInput& input) {
    return effectAlert(input.events, input.structure, input.info ? &*input.info : nullptr);
}

Hud makeHud(const HudInput& input) {
    Hud hud;
    hud.title = shownTitle(input);
    hud.state = stateText(input);
    hud.state_tone = stateTone(input);
    if (input.sought) hud.lock = input.sought->lock;
    hud.notice = input.notice;
    hud.messages = input.messages;
    hud.alert = alertOf(input);
    hud.legend = input.legend;
    hud.modes = input.modes;
    hud.rows = taskRows(input);
    if (input.show_details) hud.details = detailRows(input);
    if (input.show_watchers && !input.show_details) hud.watchers = watcherRows(input.watchers);
    if (input.show_help) hud.help = input.help;
    // Who has found the keys needs no hint.
    if (!input.show_help && !input.show_watchers && !input.show_details) hud.hint = input.hint;
    if (input.connection == Connection::kNoServer && input.sought) hud.page = waitingPage(*input.sought);
    if (input.is_in_eyes) hud.hint.reset();
    if (input.is_in_eyes || hud.page) removeFigures(hud);
    return hud;
}

}  // namespace bonemill
