// Here are the panel's parts about the session: commands, training and who is watching.
#include <imgui.h>

#include <iterator>

#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/session_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {

void PanelContent::buildSession() {
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) {
        ImGui::PushTextWrapPos();
        say(why_not, HudTone::kWarning);
        ImGui::PopTextWrapPos();
    }
    ImGui::BeginDisabled(!why_not.empty());
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    box("Pause milling", Action::kPauseMilling, is_paused,
        "The tool still feels the bone but removes nothing");
    button("Put the bone back", Action::kResetBone, "Everything that was removed is there again");
    gap();
    buildCheckpoints();
    gap();
    buildTools();
    gap();
    buildAccuracy();
    if (session_.status && session_.status->has_device()) {
        gap();
        button("Reset the device", Action::kResetDevice, "Brings it out of a stop whose cause is gone");
    }
    ImGui::EndDisabled();
    gap();
    buildEnd();
}

void PanelContent::buildCheckpoints() {
    button("Save a checkpoint", Action::kSaveCheckpoint, "Keeps the bone as it is now, to come back to it");
    if (!session_.status || session_.status->checkpoints().empty()) {
        sayQuietly("no checkpoint yet");
        return;
    }
    const auto& checkpoints = session_.status->checkpoints();
    for (auto checkpoint = checkpoints.rbegin(); checkpoint != checkpoints.rend(); ++checkpoint) {
        const std::string label = "Back to " + std::to_string(checkpoint->id());
        const std::string what =
            checkpoint == checkpoints.rbegin()
                ? withKey("The bone as it was at the last checkpoint", Action::kLastCheckpoint)
                : "The bone as it was at this checkpoint";
        if (button(label, what.c_str())) {
            topics::Command command;
            command.set_restore_checkpoint(checkpoint->id());
            send(command);
        }
        ImGui::SameLine();
        say(clockText(checkpoint->session_s()), HudTone::kPlain);
        ImGui::SameLine();
        sayQuietly(readableText(checkpoint->removed_mm3(), " mm\u00b3") + " removed");
    }
}

void PanelContent::buildTools() {
    sayQuietly("Tool (" + keyLabelOf(Action::kNextTool) + ": the next one)");
    const int count = session_.info ? session_.info->tool_names_size() : 0;
    if (count == 0) ImGui::TextUnformatted("the scene's only one");
    for (int i = 0; i < count; ++i) {
        const std::string label = session_.info->tool_names(i) + "##tool " + std::to_string(i);
        if (!choice(label, session_.info->tool_index() == uint32_t(i), "Puts this tool into the hand"))
            continue;
        topics::Command command;
        command.set_select_tool(uint32_t(i));
        send(command);
    }
}

void PanelContent::buildAccuracy() {
    sayQuietly("Accuracy (keys " + keyLabelOf(Action::kAccuracyScene) + " to " +
               keyLabelOf(Action::kAccuracy4) + ")");
    const std::string in_force = session_.status ? session_.status->preset() : "";
    for (size_t key = 1; key < std::size(kAccuracyOfKey); ++key) {
        const std::string name(kAccuracyOfKey[key]);
        if (key % 2 == 0) ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.5f);
        if (choice(name, in_force == name, "How finely contact and force are computed"))
            act(Action(int(Action::kAccuracyScene) + int(key)));
    }
    button("As the scene file says", Action::kAccuracyScene, "The accuracy that the scene starts with");
}

void PanelContent::buildEnd() {
    const std::string why_not = whyNotEndSession(session_);
    ImGui::BeginDisabled(!why_not.empty());
    if (!is_ending_) {
        is_ending_ =
            button("End the session", why_not.empty() ? "Stops the server, for everybody" : why_not.c_str());
    } else {
        say("Bone and checkpoints go with it. End it?", HudTone::kWarning);
        if (button("End", "Stops the server, for everybody")) {
            topics::Command command;
            command.set_shut_down(true);
            send(command);
            is_ending_ = false;
        }
        ImGui::SameLine();
        if (button("Go on", "Nothing is stopped")) is_ending_ = false;
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
            when += " to " + clockText(fault.last_s) + ", " + std::to_string(fault.count) + " times";
        sayQuietly(when + (fault.lasts ? ", lasts" : ""));
        say(fault.text, fault.lasts ? fault.tone : HudTone::kPlain);
    }
    ImGui::PopTextWrapPos();
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
    row(session_.name + " (you)", self);
    for (const topics::Viewer& other : session_.others) row(other.name(), other);
}

}  // namespace bonemill
