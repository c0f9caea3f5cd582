// Here are the panel's parts that lead a replay, and compare it with another attempt.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "render_client/hand/controls/past_attempts.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/palette.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr int kDifferenceParts = 3;  // as topics::Comparison says

ImVec4 legendColour(const scene::Material& material) {
    const scene::Color colour = shownColour(material.color());
    return {float(colour.red()), float(colour.green()), float(colour.blue()), 1};
}

std::string whoseText(const PastAttempt& attempt) {
    const bool is_experts = std::filesystem::path(attempt.stem).parent_path().filename() == "experts";
    return (is_experts ? "expert " : "") + attempt.trainee + ", " + attempt.start + ", " + attempt.score;
}

topics::Command compareWith(const std::string& result) {
    topics::Command command;
    command.mutable_replay()->set_compare_with(result);
    return command;
}

}  // namespace

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
    if (!replay.event().empty()) sayWrapped(replay.event(), HudTone::kGood);
    ImGui::PushTextWrapPos();
    sayQuietly(keyLabelOf(Action::kRemovalHere) +
               " or a right click on the bone: when was it removed there?");
    ImGui::PopTextWrapPos();
    ImGui::EndDisabled();
    if (!session_.recording.empty() &&
        button("Clip", "Writes the ten seconds around this moment as a video, seen from here"))
        wishes_.make_clip = true;
    if (!session_.recording.empty()) buildWhatIf();
    gap();
    buildComparison();
}

void PanelContent::buildComparison() {
    const topics::Replay& replay = session_.status->replay();
    const std::vector<const PastAttempt*> attempts = comparableAttempts(session_);
    if (!replay.has_comparison() && attempts.empty()) return;
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    if (replay.has_comparison()) buildCompared(replay.comparison());
    if (!attempts.empty()) sayQuietly("Compare with ...");
    for (size_t n = 0; n < attempts.size(); ++n) {
        const std::filesystem::path stem = attempts[n]->stem;
        const std::string label = whoseText(*attempts[n]) + "##compare " + std::to_string(n + 1);
        if (button(label, "Its tool goes along, from the beginning of both attempts on"))
            send(compareWith(stem.filename().string()));
    }
    ImGui::EndDisabled();
}

void PanelContent::buildCompared(const topics::Comparison& comparison) {
    say("Compared with " + comparison.attempt(), HudTone::kPlain);
    if (!comparison.problem().empty()) {
        sayWrapped(comparison.problem(), HudTone::kWarning);
    } else if (comparison.is_on_its_way()) {
        sayQuietly("on its way");
    } else {
        sayQuietly("at " + clockText(comparison.attempt_s()) + " of " + clockText(comparison.length_s()) +
                   " of the attempt");
    }
    if (comparison.problem().empty() && comparison.first_material() > 0) {
        if (box("Difference", comparison.shows_difference(),
                "Colours on the bone tell who has removed what")) {
            topics::Command command;
            command.mutable_replay()->set_shows_difference(!comparison.shows_difference());
            send(command);
        }
        if (comparison.shows_difference()) buildLegend(comparison.first_material());
    }
    if (comparison.problem().empty() && box("Both bones", comparison.shows_beside(),
                                            "The other attempt's bone is seen at the right of this one")) {
        topics::Command command;
        command.mutable_replay()->set_shows_beside(!comparison.shows_beside());
        send(command);
    }
    if (button("Alone", "The other attempt is not shown any more")) send(compareWith(""));
}

// `first` is 1 + its index in SceneInfo.materials.
void PanelContent::buildLegend(uint32_t first) {
    if (!session_.info || int64_t(first) - 1 + kDifferenceParts > session_.info->materials_size()) return;
    for (int part = 0; part < kDifferenceParts; ++part) {
        const scene::Material& material = session_.info->materials(int(first) - 1 + part);
        ImGui::ColorButton(("##difference " + std::to_string(part)).c_str(), legendColour(material),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker,
                           ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
        ImGui::SameLine();
        say(material.name(), HudTone::kPlain);
    }
}

}  // namespace bonemill
