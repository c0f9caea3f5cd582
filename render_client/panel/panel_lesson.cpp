// Here is the panel's part about a lesson: scenes to choose from, the trainee, and how the attempts went.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "render_client/hud/figure_text.h"
#include "render_client/hud/session_text.h"
#include "render_client/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kPictureWidth = 92, kPictureHeight = 69;  // pixels at scale 1
constexpr int kRowsOfTable = 8;

std::string detailsOf(const topics::SceneChoice& scene) {
    std::string text;
    for (const std::string& tool : scene.tools()) text += (text.empty() ? "" : ", ") + tool;
    if (scene.expected_s() > 0)
        text += (text.empty() ? "about " : "; about ") +
                std::to_string(std::max(1l, std::lround(scene.expected_s() / 60))) + " min";
    return text;
}

}  // namespace

void PanelContent::buildLesson() {
    const topics::Lesson& lesson = *session_.lesson;
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) {
        ImGui::PushTextWrapPos();
        say(why_not, HudTone::kWarning);
        ImGui::PopTextWrapPos();
    }
    ImGui::BeginDisabled(!why_not.empty());
    buildTrainee(lesson);
    gap();
    sayQuietly("Scene (" + keyLabelOf(Action::kNextScene) + ": the next one)");
    for (const topics::SceneChoice& scene : lesson.scenes()) buildScene(lesson, scene);
    ImGui::EndDisabled();
    if (!lesson.attempts().empty()) {
        gap();
        buildAttempts(lesson);
    }
}

void PanelContent::buildTrainee(const topics::Lesson& lesson) {
    if (draft_.wants_keyboard) ImGui::SetKeyboardFocusHere();
    draft_.wants_keyboard = false;
    ImGui::PushItemWidth(-1);
    const bool is_entered = ImGui::InputTextWithHint(
        "##trainee", withKey("Trainee's name or number", Action::kTrainee).c_str(), draft_.trainee.data(),
        draft_.trainee.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    note("##trainee", "Who tries; Enter starts the attempt");
    ImGui::PopItemWidth();
    const bool is_started =
        button("Start", "On whole bone, with the clock at zero; an attempt under way ends") || is_entered;
    if (is_started) startAttempt(lesson);
    ImGui::SameLine();
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    button(is_paused ? "Go on" : "Pause", Action::kPauseMilling, "The clock of the attempt rests, too");
    ImGui::BeginDisabled(!lesson.is_running());
    button("Stop", Action::kStopAttempt, "Ends the attempt, and shows how it went");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (button("Next trainee", "Ends an attempt under way, and asks for the next name")) {
        if (lesson.is_running()) act(Action::kStopAttempt);
        draft_.trainee.fill(0);
        draft_.wants_keyboard = true;
    }
    if (lesson.is_running()) say(lesson.trainee() + " is at it", HudTone::kGood);
}

// Whoever types no name is counted.
void PanelContent::startAttempt(const topics::Lesson& lesson) {
    const std::string typed = draft_.trainee.data();
    const uint32_t last = lesson.attempts().empty() ? 0 : lesson.attempts().rbegin()->number();
    topics::Command command;
    command.set_start_attempt(typed.find_first_not_of(' ') == std::string::npos ? std::to_string(last + 1)
                                                                                : typed);
    send(command);
}

void PanelContent::buildScene(const topics::Lesson& lesson, const topics::SceneChoice& scene) {
    const bool is_chosen = scene.id() == lesson.scene_id();
    ImGui::PushID(scene.id().c_str());
    const ImVec2 size(kPictureWidth * scale_, kPictureHeight * scale_);
    const auto picture = pictures_.find(scene.id());
    if (picture != pictures_.end() && picture->second.number > 0) {
        ImGui::Image(ImTextureID(intptr_t(picture->second.number)), size);
    } else {
        ImGui::Dummy(size);
    }
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::BeginDisabled(!scene.problem().empty());
    const std::string title = scene.title().empty() ? scene.id() : scene.title();
    const bool is_pressed = ImGui::RadioButton(title.c_str(), is_chosen);
    note(title, scene.problem().empty() ? "Teach this scene" : scene.problem().c_str());
    if (is_pressed && !is_chosen) {
        topics::Command command;
        command.set_choose_scene(scene.id());
        send(command);
    }
    ImGui::EndDisabled();
    ImGui::PushTextWrapPos();
    if (!scene.task().empty()) say(scene.task(), HudTone::kPlain);
    const std::string details = detailsOf(scene);
    if (!details.empty()) sayQuietly(details);
    if (!scene.problem().empty()) say(scene.problem(), HudTone::kWarning);
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    ImGui::PopID();
}

void PanelContent::buildAttempts(const topics::Lesson& lesson) {
    sayQuietly("Attempts of this class");
    const int rows = std::min(lesson.attempts_size(), kRowsOfTable) + 1;
    const ImVec2 size(0, ImGui::GetTextLineHeightWithSpacing() * (float(rows) + 0.5f));
    const ImGuiTableFlags flags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp;
    if (ImGui::BeginTable("attempts", 5, flags, size)) {
        for (const char* title : {"", "Trainee", "Time", "Removed", "Force"}) ImGui::TableSetupColumn(title);
        ImGui::TableHeadersRow();
        const auto cell = [](const std::string& text) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.c_str());
        };
        for (auto attempt = lesson.attempts().rbegin(); attempt != lesson.attempts().rend(); ++attempt) {
            cell(std::to_string(attempt->number()));
            cell(attempt->trainee());
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", titleOf(lesson, attempt->scene_id()).c_str());
            cell(clockText(attempt->time_s()));
            cell(readableText(attempt->removed_mm3(), " mm\u00b3"));
            cell(readableText(attempt->max_force_n(), " N"));
        }
        ImGui::EndTable();
    }
    if (button("Save as CSV", "Writes all figures of these attempts into a file here, for a spreadsheet"))
        wishes_.save_attempts = true;
}

}  // namespace bonemill
