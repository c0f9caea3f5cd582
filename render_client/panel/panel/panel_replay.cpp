// Here is the panel's part that leads a replay: where it stands, and the way to another moment.
#include <imgui.h>

#include "render_client/look/hud/figure_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {

void PanelContent::buildReplay() {
    const topics::Replay& replay = session_.status->replay();
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) say(why_not, HudTone::kWarning);
    ImGui::BeginDisabled(!why_not.empty());
    const double now_s = session_.status->session_s(), length_s = std::max(replay.length_s(), 1e-3);
    say(clockText(now_s) + " of " + clockText(replay.length_s()), HudTone::kPlain);
    ImGui::SameLine();
    sayQuietly(replay.is_seeking() ? "on its way" : replay.is_playing() ? "plays" : "paused");
    if (const auto to = slider("Moment", now_s / length_s, 0, "Leads to that part of the recording")) {
        topics::Command command;
        command.mutable_replay()->set_seek_s(*to * length_s);
        send(command);
    }
    button(replay.is_playing() ? "Pause" : "Play", Action::kPauseMilling, "Holds the recording, or goes on");
    ImGui::SameLine();
    button("-5 s", Action::kReplayBack, "Back");
    ImGui::SameLine();
    button("+5 s", Action::kReplayAhead, "Ahead");
    button("Slower", Action::kReplaySlower, "Half as fast");
    ImGui::SameLine();
    button("Faster", Action::kReplayFaster, "Twice as fast");
    ImGui::SameLine();
    sayQuietly(readableText(replay.speed(), " \u00d7"));
    button("Event before", Action::kPreviousEvent, "To what happened before this moment");
    button("Next event", Action::kNextEvent, "To what happens next");
    if (!replay.event().empty()) {
        ImGui::PushTextWrapPos();
        say(replay.event(), HudTone::kGood);
        ImGui::PopTextWrapPos();
    }
    ImGui::PushTextWrapPos();
    sayQuietly(keyLabelOf(Action::kRemovalHere) +
               " or a right click on the bone: when was it removed there?");
    ImGui::PopTextWrapPos();
    ImGui::EndDisabled();
}

}  // namespace bonemill
