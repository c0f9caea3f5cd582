// Here are the panel's parts about the session: commands, training, who is watching, and what people write
// and draw.
#include <imgui.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr size_t kMaxListed = 40;

ImVec4 strokeColour(uint32_t colour) {
    const auto part = [colour](int shift) { return float(colour >> shift & 0xff) / 255; };
    return {part(16), part(8), part(0), 1};
}

std::vector<const topics::Remark*> newestFirst(const std::map<uint32_t, topics::Remark>& remarks) {
    std::vector<const topics::Remark*> listed;
    for (const auto& [place, remark] : remarks) listed.push_back(&remark);
    std::ranges::sort(listed, std::greater{}, [](const topics::Remark* remark) { return remark->number(); });
    return listed;
}

}  // namespace

void PanelContent::buildSession() {
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) sayWrapped(why_not, HudTone::kWarning);
    ImGui::BeginDisabled(!why_not.empty());
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    box(tr("Pause milling"), Action::kPauseMilling, is_paused,
        tr("The tool still feels the bone but removes nothing"));
    button(tr("Put the bone back"), Action::kResetBone, tr("Everything that was removed is there again"));
    gap();
    buildCheckpoints();
    gap();
    buildTools();
    gap();
    buildAccuracy();
    if (session_.status && session_.status->has_device()) {
        gap();
        button(tr("Reset the device"), Action::kResetDevice,
               tr("Brings it out of a stop whose cause is gone"));
    }
    ImGui::EndDisabled();
    gap();
    buildEnd();
}

void PanelContent::buildCheckpoints() {
    button(tr("Save a checkpoint"), Action::kSaveCheckpoint,
           tr("Keeps the bone as it is now, to come back to it"));
    if (!session_.status || session_.status->checkpoints().empty()) {
        sayQuietly(tr("no checkpoint yet"));
        return;
    }
    const auto& checkpoints = session_.status->checkpoints();
    for (auto checkpoint = checkpoints.rbegin(); checkpoint != checkpoints.rend(); ++checkpoint) {
        const std::string label = tr("Back to {1}", {std::to_string(checkpoint->id())});
        const std::string what =
            checkpoint == checkpoints.rbegin()
                ? withKey(tr("The bone as it was at the last checkpoint"), Action::kLastCheckpoint)
                : tr("The bone as it was at this checkpoint");
        if (button(label, what.c_str()))
            send(commandWith(&topics::Command::set_restore_checkpoint, checkpoint->id()));
        ImGui::SameLine();
        say(clockText(checkpoint->session_s()), HudTone::kPlain);
        ImGui::SameLine();
        sayQuietly(tr("{1} removed", {readableText(checkpoint->removed_mm3(), " mm\u00b3")}));
    }
}

void PanelContent::buildTools() {
    sayQuietly(tr("Tool ({1}: the next one)", {keyLabelOf(Action::kNextTool)}));
    const int count = session_.info ? session_.info->tool_names_size() : 0;
    if (count == 0) ImGui::TextUnformatted(tr("the scene's only one"));
    for (int i = 0; i < count; ++i) {
        const std::string label = session_.info->tool_names(i) + "##tool " + std::to_string(i);
        if (choice(label, session_.info->tool_index() == uint32_t(i), tr("Puts this tool into the hand")))
            send(commandWith(&topics::Command::set_select_tool, uint32_t(i)));
    }
}

void PanelContent::buildAccuracy() {
    sayQuietly(tr("Accuracy (keys {1} to {2})",
                  {keyLabelOf(Action::kAccuracyScene), keyLabelOf(Action::kAccuracy4)}));
    const std::string in_force = session_.status ? session_.status->preset() : "";
    for (size_t key = 1; key < std::size(kAccuracyOfKey); ++key) {
        const std::string name(kAccuracyOfKey[key]);
        if (key % 2 == 0) ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.5f);
        if (choice(name, in_force == name, tr("How finely contact and force are computed")))
            act(Action(int(Action::kAccuracyScene) + int(key)));
    }
    button(tr("As the scene file says"), Action::kAccuracyScene,
           tr("The accuracy that the scene starts with"));
}

void PanelContent::buildEnd() {
    const std::string why_not = whyNotEndSession(session_);
    ImGui::BeginDisabled(!why_not.empty());
    if (!is_ending_) {
        is_ending_ = button(tr("End the session"),
                            why_not.empty() ? tr("Stops the server, for everybody") : why_not.c_str());
    } else {
        say(tr("Bone and checkpoints go with it. End it?"), HudTone::kWarning);
        if (button(tr("End"), tr("Stops the server, for everybody"))) {
            send(commandWith(&topics::Command::set_shut_down, true));
            is_ending_ = false;
        }
        ImGui::SameLine();
        if (button(tr("Go on"), tr("Nothing is stopped"))) is_ending_ = false;
    }
    ImGui::EndDisabled();
}

void PanelContent::buildTraining() {
    for (const HudRow& row : trainingRows(session_.status->training())) {
        if (!row.label.empty()) {
            const float middle = ImGui::GetContentRegionAvail().x * 0.55f;
            ImGui::PushTextWrapPos(middle);
            sayQuietly(row.label);
            ImGui::PopTextWrapPos();
            ImGui::SameLine(middle);
        }
        say(row.value, row.tone);
    }
}

void PanelContent::buildFaults() {
    ImGui::PushTextWrapPos();
    for (const FaultEntry& fault : session_.faults) {
        std::string when = clockText(fault.first_s);
        if (fault.count > 1)
            when = tr("{1} to {2}, {3} times", {when, clockText(fault.last_s), std::to_string(fault.count)});
        sayQuietly(fault.lasts ? tr("{1}, lasts", {when}) : when);
        say(fault.text, fault.lasts ? fault.tone : HudTone::kPlain);
    }
    ImGui::PopTextWrapPos();
}

// The curves share the limits that the device and the loop have.
void PanelContent::buildPlots() {
    const topics::Status* const status = session_.status;
    const bool has_device = status && status->has_device();
    buildPlot(tr("Force"), plots_.force(), has_device ? status->device().max_force_n() : 0, " N");
    buildPlot(tr("Torque"), plots_.torque(), has_device ? status->device().max_torque_nmm() : 0,
              " N\u00b7mm");
    const bool has_rate = status && status->rate_hz() > 1;
    buildPlot(tr("Tick p99"), plots_.tick(), has_rate ? kPerMicrosecond / status->rate_hz() : 0, " \u00b5s");
}

void PanelContent::buildPlot(const char* name, const PlotHistory::Curve& curve, double limit,
                             const char* unit) {
    constexpr float kHeight = 3.2f;  // letters' heights
    const std::string now = readableText(double(curve.newest()), unit);
    const std::string most = readableText(double(curve.largest()), unit);
    sayQuietly(limit > 0 ? tr("{1} {2}, most {3} (limit {4})", {name, now, most, readableText(limit, unit)})
                         : tr("{1} {2}, most {3}", {name, now, most}));
    const float highest = std::max(curve.largest() * 1.1f, 1e-3f);
    ImGui::PlotLines((std::string("##") + name).c_str(), curve.values.data(), int(PlotHistory::kLength),
                     int(curve.next), nullptr, 0, highest,
                     ImVec2(ImGui::GetContentRegionAvail().x, kHeight * ImGui::GetFontSize()));
}

void PanelContent::buildWatchers() {
    const auto row = [this](const std::string& name, const topics::Viewer& watcher) {
        say(watcherName(name), HudTone::kPlain);
        ImGui::SameLine();
        sayQuietly(watcherText(watcher));
    };
    topics::Viewer self;
    self.set_role(session_.role);
    self.set_frame_rate_hz(session_.frame_rate_hz);
    self.set_is_complete(session_.is_complete);
    self.set_is_holding(controls_.toolHold().isHolding());
    row(tr("{1} (you)", {session_.name}), self);
    for (const topics::Viewer& other : session_.others) row(other.name(), other);
}

void PanelContent::buildRemarks() {
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    buildNote();
    box(tr("Draw"), Action::kDraw, controls_.isDrawing(),
        tr("Left drags draw on the bone, for everyone to see"));
    ImGui::EndDisabled();
    ImGui::SameLine();
    box(tr("Show"), Action::kRemarks, settings_.show_remarks, tr("Notes and strokes on the bone"));
    if (!session_.remarks || session_.remarks->empty()) return;
    const std::vector<const topics::Remark*> listed = newestFirst(*session_.remarks);
    for (size_t n = 0; n < std::min(listed.size(), kMaxListed); ++n) buildRemark(*listed[n]);
    if (listed.size() > kMaxListed)
        sayQuietly(tr("and {1} older ones", {std::to_string(listed.size() - kMaxListed)}));
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    if (button(tr("Erase all"), tr("Takes all notes and strokes away, for everybody")))
        send(commandWith(&topics::Command::set_erase_remark, 0));
    ImGui::EndDisabled();
}

void PanelContent::buildNote() {
    if (remark_draft_.wants_keyboard) ImGui::SetKeyboardFocusHere();
    remark_draft_.wants_keyboard = false;
    ImGui::PushItemWidth(-1);
    const bool is_entered = ImGui::InputTextWithHint(
        "##note", withKey(tr("Note for everyone"), Action::kNote).c_str(), remark_draft_.note.data(),
        remark_draft_.note.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    note("##note", tr("Enter shows it to everyone, with the session's clock"));
    ImGui::PopItemWidth();
    if (remark_draft_.place &&
        box(tr("at the place on the bone"), true, tr("Where the mouse was; otherwise nowhere")))
        remark_draft_.place.reset();
    if (is_entered) sendNote();
}

void PanelContent::sendNote() {
    const std::string typed = remark_draft_.note.data();
    if (typed.find_first_not_of(' ') != std::string::npos) {
        topics::Command command;
        topics::Remark& remark = *command.mutable_add_remark();
        remark.set_note(typed);
        if (remark_draft_.place)
            for (const double value : *remark_draft_.place) remark.add_points_m(float(value));
        send(command);
    }
    remark_draft_ = {.place = {}, .leaves_keyboard = true};
}

void PanelContent::buildRemark(const topics::Remark& remark) {
    const std::string number = std::to_string(remark.number());
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    if (button(tr("Erase {1}", {number}), tr("Takes it away, for everybody")))
        send(commandWith(&topics::Command::set_erase_remark, remark.number()));
    ImGui::EndDisabled();
    ImGui::SameLine();
    const std::string author =
        remark.author().empty() ? tr(roleName(remark.role()).c_str()) : remark.author();
    ImGui::PushTextWrapPos();
    if (remark.note().empty()) {
        ImGui::ColorButton(("##colour" + number).c_str(), strokeColour(remark.color()),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker,
                           ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
        ImGui::SameLine();
    }
    sayQuietly(clockText(remark.session_s()) + " " + author);
    if (!remark.note().empty()) say(remark.note(), HudTone::kPlain);
    ImGui::PopTextWrapPos();
}

}  // namespace bonemill
