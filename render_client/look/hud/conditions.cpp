#include "render_client/look/hud/conditions.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "common/device_messages/device_messages.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/device_lines.h"

namespace bonemill {
namespace {

constexpr const char* kLessDetail =
    trMark("A little less detail is felt: the computer is busy. You can go on.");

constexpr struct {
    const char* name;
    const char* text;
    HudTone tone;
} kWords[] = {
    {"overrun",
     trMark(
         "The session's computer, which has the handle, was too slow for a moment: the force may have been "
         "rough. Close other programs on it."),
     HudTone::kWarning},
    {"stale_device",
     trMark(
         "The handle was not heard of for a moment, and its force went off. If it happens again, check its "
         "cable."),
     HudTone::kAlarm},
    {"bad_device_pose",
     trMark("The handle reported an impossible place, which was ignored. If it happens again, tell your "
            "instructor."),
     HudTone::kAlarm},
    {"solve",
     trMark("The force faded: the computer could not calculate it. Lift the tool off the bone until you feel "
            "it again."),
     HudTone::kAlarm},
    {"motion_clamped", trMark("Your hand was faster than the tool may be: it came behind. Move more slowly."),
     HudTone::kPlain},
    {"force_clamped",
     trMark("You pressed harder than the handle can push back: less was felt than there is. Press less."),
     HudTone::kPlain},
    {"shell_overflow",
     trMark(
         "A part of the milled surface cannot be felt: the memory for it is full. Trust the picture there."),
     HudTone::kWarning},
    {"milling_cut_short", trMark("Bone was removed a moment late: it was much at once. You can go on."),
     HudTone::kPlain},
    {"coarser_shell", kLessDetail, HudTone::kPlain},
    {"volume_full",
     trMark("The computer's memory is full: some bone was not removed. End the attempt and tell your "
            "instructor."),
     HudTone::kAlarm},
    {"stalled", trMark("The force was a little off, and corrects itself. You can go on."), HudTone::kPlain},
    {"implausible_device",
     trMark(
         "The handle sent impossible data, which were ignored. If it happens again, tell your instructor."),
     HudTone::kAlarm},
    {"early_samples", trMark("The computer cannot keep up with the handle's signals. You can go on."),
     HudTone::kPlain},
    {"fewer_samples", kLessDetail, HudTone::kPlain},
    {"as_balanced",
     trMark("The computer is too slow for the chosen accuracy, and takes 'balanced': a little less detail is "
            "felt. You can go on."),
     HudTone::kPlain},
    {"as_fast",
     trMark(
         "The computer is too slow for the chosen accuracy, and takes 'fast': a little less detail is felt. "
         "You can go on."),
     HudTone::kPlain},
    {"not_recorded",
     trMark("Not all of the session is recorded: the disk is full or slow. Tell your instructor before you "
            "go on."),
     HudTone::kAlarm},
};

// To a trainee it is the same whether a tick ran out of time or left contact points out in time.
Condition wordsOf(const std::string& fault) {
    const std::string name = fault == "contact_overflow" ? "overrun" : fault;
    const auto known = std::ranges::find_if(kWords, [&](const auto& words) { return words.name == name; });
    if (known != std::end(kWords)) return {name, tr(known->text), known->tone, true, false};
    return {name, tr("The server reports: {1}.", {name}), HudTone::kWarning, true, false};
}

constexpr char kStaleDevice[] = "stale_device";

void addConnection(Connection connection, std::vector<Condition>& conditions) {
    if (connection == Connection::kServerLost)
        conditions.push_back({"server",
                              tr("The picture stands still, for there is no connection; the burr may still "
                                 "cut. Release the pedal. If it lasts, tell your instructor."),
                              HudTone::kAlarm, true});
    if (connection == Connection::kServerEnded)
        conditions.push_back(
            {"end", tr("The session has ended. Wait: the next one is shown here when somebody starts it.")});
}

// The server latches its faults; only of the device's silence it says also whether it lasts.
void addTickFaults(const topics::Status& status, std::vector<Condition>& conditions) {
    const bool is_stale = status.device_stale() && status.ticks() > 0;
    if (is_stale)
        conditions.push_back({kStaleDevice,
                              tr("The handle sends nothing: there is no force. Check its cable and switch."),
                              HudTone::kAlarm, true});
    if (status.faults() == 0) return;
    for (const Condition& fault : faultWords(status.fault_text()))
        if (!is_stale || fault.id != kStaleDevice) conditions.push_back(fault);
}

void addDevice(const HudInput& input, std::vector<Condition>& conditions) {
    if (!input.status->has_device()) return;
    const topics::Device& device = input.status->device();
    const topics::ToolState* const tool = input.tool ? &*input.tool : nullptr;
    if (const auto stop = deviceStop(device, tool))
        conditions.push_back({"stop", stop->text, stop->tone, true});
    // A scripted hand that makes way for the mouse waits for nothing.
    const bool makes_way =
        device.script().taken_over_by() != 0 && device.kind() != uint32_t(DeviceKind::kPointer);
    if (const auto wait = deviceWait(device, tool); wait && !makes_way)
        conditions.push_back({"wait", wait->text, wait->tone});
    if (device.script().has_ended() && !input.status->has_replay())
        conditions.push_back({"script", tr("The automatic demonstration has ended.")});
}

// Who presses the pedal wonders.
void addPause(const HudInput& input, std::vector<Condition>& conditions) {
    const bool is_asked = input.tool && input.tool->buttons() != 0;
    if (is_asked && input.status->is_milling_paused())
        conditions.push_back({"paused",
                              tr("Milling is paused. Press P to go on, or Start to begin the next attempt."),
                              HudTone::kWarning});
    else if (is_asked && input.tool->waits_for_release())
        conditions.push_back({"release",
                              tr("The bone is whole again. Release the pedal: pressed anew, it cuts."),
                              HudTone::kWarning});
}

}  // namespace

FaultList::Kept* FaultList::find(const std::string& id) {
    const auto kept = std::ranges::find(kept_, id, [](const Kept& k) { return k.condition.id; });
    return kept == kept_.end() ? nullptr : &*kept;
}

void FaultList::begin(Kept& kept, double session_s, Clock::time_point now) {
    if (kept.entry.count++ == 0) kept.entry.first_s = session_s;
    kept.began = now;
}

// What has only happened is over at once; it begins anew when it begins to last.
void FaultList::observe(const std::vector<Condition>& conditions, double session_s, Clock::time_point now) {
    for (Kept& kept : kept_) kept.is_present = false;
    for (const Condition& condition : conditions) {
        Kept* kept = find(condition.id);
        if (!kept && kept_.size() >= kMaxKept) continue;
        if (!kept) kept = &kept_.emplace_back();
        const bool is_new = kept->entry.count == 0 || (condition.lasts && !kept->entry.lasts);
        kept->condition = condition;
        kept->is_present = true;
        if (is_new) begin(*kept, session_s, now);
        if (is_new || condition.lasts) {
            kept->entry.text = condition.text;
            kept->entry.tone = condition.tone;
            kept->entry.last_s = session_s;
            kept->ended = now;
        }
        kept->entry.lasts = condition.lasts;
    }
    for (Kept& kept : kept_)
        if (!kept.is_present) kept.entry.lasts = false;
}

bool FaultList::isSaid(const Kept& kept) {
    return !kept.condition.is_fault || kept.entry.tone != HudTone::kPlain;
}

float FaultList::opacity(const Kept& kept, Clock::time_point now) {
    if (kept.entry.lasts) return 1;
    const Clock::time_point end = std::max(kept.ended, kept.began + kShown);
    const std::chrono::duration<float> left = end + kFade - now, fade = kFade;
    return std::clamp(left / fade, 0.0f, 1.0f);
}

std::vector<HudNotice> FaultList::said(Clock::time_point now) const {
    std::vector<const Kept*> visible;
    for (const Kept& kept : kept_)
        if (isSaid(kept) && opacity(kept, now) > 0) visible.push_back(&kept);
    std::ranges::stable_sort(visible, [](const Kept* a, const Kept* b) {
        return std::pair(a->entry.lasts, a->entry.tone) > std::pair(b->entry.lasts, b->entry.tone);
    });
    std::vector<HudNotice> said;
    const bool are_all = visible.size() <= kMaxShown;
    const size_t in_full = are_all ? visible.size() : kMaxShown - 1;
    for (size_t i = 0; i < in_full; ++i)
        said.push_back({visible[i]->entry.text, visible[i]->entry.tone, opacity(*visible[i], now)});
    if (are_all) return said;
    float most = 0;
    for (size_t i = in_full; i < visible.size(); ++i) most = std::max(most, opacity(*visible[i], now));
    said.push_back({tr("and {1} more, listed in the panel", {std::to_string(visible.size() - in_full)}),
                    HudTone::kWarning, most});
    return said;
}

std::vector<FaultEntry> FaultList::faults() const {
    std::vector<FaultEntry> faults;
    for (const Kept& kept : kept_)
        if (kept.condition.is_fault) faults.push_back(kept.entry);
    return faults;
}

std::vector<Condition> faultWords(const std::string& names) {
    std::vector<Condition> faults;
    std::istringstream words(names);
    for (std::string name; words >> name;) {
        while (name.ends_with(',')) name.pop_back();
        if (name.empty()) continue;
        Condition fault = wordsOf(name);
        if (std::ranges::find(faults, fault.id, &Condition::id) == faults.end())
            faults.push_back(std::move(fault));
    }
    return faults;
}

std::vector<Condition> conditionsOf(const HudInput& input) {
    std::vector<Condition> conditions;
    addConnection(input.connection, conditions);
    if (input.other_server)
        conditions.push_back(
            {"other_server",
             tr("Two computers run this session, the other with the scene '{1}'. You see the "
                "first; ask your instructor to end one.",
                {*input.other_server}),
             HudTone::kWarning});
    const bool is_there = input.connection == Connection::kReceiving || input.connection == Connection::kLive;
    if (!input.status || !is_there) return conditions;  // what a server said last is no news of it
    addDevice(input, conditions);
    addPause(input, conditions);
    addTickFaults(*input.status, conditions);
    return conditions;
}

}  // namespace bonemill
