// Here are the panel's parts that lead a replay, and compare it with another attempt.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "render_client/hand/controls/past_attempts.h"
#include "render_client/language/language.h"
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
    const std::string who = is_experts ? tr("expert {1}", {attempt.trainee}) : attempt.trainee;
    return who + ", " + attempt.start + ", " + attempt.score;
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
    say(tr("{1} of {2}", {clockText(now_s), clockText(replay.length_s())}), HudTone::kPlain);
    ImGui::SameLine();
    sayQuietly(replay.is_seeking() ? tr("on its way") : replay.is_playing() ? tr("plays") : tr("paused"));
    if (const auto to =
            slider(tr("Moment"), now_s / length_s, 0, tr("Leads to that part of the recording"))) {
        topics::Command command;
        command.mutable_replay()->set_seek_s(*to * length_s);
        send(command);
    }
    button(replay.is_playing() ? tr("Pause") : tr("Play"), Action::kPauseMilling,
           tr("Holds the recording, or goes on"));
    buttonBeside("-5 s", Action::kReplayBack, trIn("replay", "Back"));
    buttonBeside("+5 s", Action::kReplayAhead, tr("Ahead"));
    button(tr("Slower"), Action::kReplaySlower, tr("Half as fast"));
    buttonBeside(tr("Faster"), Action::kReplayFaster, tr("Twice as fast"));
    ImGui::SameLine();
    sayQuietly(readableText(replay.speed(), " \u00d7"));
    button(tr("Event before"), Action::kPreviousEvent, tr("To what happened before this moment"));
    button(tr("Next event"), Action::kNextEvent, tr("To what happens next"));
    if (!replay.event().empty()) sayWrapped(replay.event(), HudTone::kGood);
    ImGui::PushTextWrapPos();
    sayQuietly(tr("{1} or a right click on the bone: when was it removed there?",
                  {keyLabelOf(Action::kRemovalHere)}));
    ImGui::PopTextWrapPos();
    ImGui::EndDisabled();
    if (!session_.recording.empty() &&
        button(tr("Clip"), tr("Writes the ten seconds around this moment as a video, seen from here")))
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
    if (!attempts.empty()) sayQuietly(tr("Compare with ..."));
    for (size_t n = 0; n < attempts.size(); ++n) {
        const std::filesystem::path stem = attempts[n]->stem;
        const std::string label = whoseText(*attempts[n]) + "##compare " + std::to_string(n + 1);
        if (button(label, tr("Its tool goes along, from the beginning of both attempts on")))
            send(compareWith(stem.filename().string()));
    }
    ImGui::EndDisabled();
}

void PanelContent::buildCompared(const topics::Comparison& comparison) {
    say(tr("Compared with {1}", {comparison.attempt()}), HudTone::kPlain);
    if (!comparison.problem().empty()) {
        sayWrapped(comparison.problem(), HudTone::kWarning);
    } else if (comparison.is_on_its_way()) {
        sayQuietly(tr("on its way"));
    } else {
        sayQuietly(tr("at {1} of {2} of the attempt",
                      {clockText(comparison.attempt_s()), clockText(comparison.length_s())}));
    }
    if (comparison.problem().empty() && comparison.first_material() > 0) {
        if (box(tr("Difference"), comparison.shows_difference(),
                tr("Colours on the bone tell who has removed what"))) {
            topics::Command command;
            command.mutable_replay()->set_shows_difference(!comparison.shows_difference());
            send(command);
        }
        if (comparison.shows_difference()) buildLegend(comparison.first_material());
    }
    if (comparison.problem().empty() &&
        box(tr("Both bones"), comparison.shows_beside(),
            tr("The other attempt's bone is seen at the right of this one"))) {
        topics::Command command;
        command.mutable_replay()->set_shows_beside(!comparison.shows_beside());
        send(command);
    }
    if (button(tr("Alone"), tr("The other attempt is not shown any more"))) send(compareWith(""));
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
