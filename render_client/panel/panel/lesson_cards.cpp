#include "render_client/panel/panel/lesson_cards.h"

#include <imgui.h>

#include <algorithm>
#include <vector>

#include "common/attempts_csv/attempts_csv.h"
#include "render_client/hand/controls/past_attempts.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

constexpr float kCardWidth = 300, kCardMargin = 14;  // pixels at scale 1
constexpr float kWidestCard = 0.34f;                 // of the picture
constexpr ImGuiWindowFlags kCard = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus;

ImVec4 colourOfCard(const HudColour& colour) {
    return {colour[0], colour[1], colour[2], colour[3]};
}

HudRow touchedRow(const topics::Attempt& attempt) {
    const topics::Training& training = attempt.training();
    const bool has_structures = training.has_damaged_mm3() || training.has_least_distance_mm() ||
                                training.has_max_protected_force_n();
    std::string touched;
    for (const std::string& name : attempt.structures_touched())
        touched += (touched.empty() ? "" : ", ") + name;
    if (!touched.empty()) return {tr("Touched"), touched, HudTone::kAlarm};
    return has_structures ? HudRow{tr("Touched"), trIn("structures", "none"), HudTone::kGood}
                          : HudRow{tr("Touched"), tr("no structures in this exercise")};
}

void addVerdict(const topics::Verdict& verdict, std::vector<HudRow>& rows) {
    if (verdict.has_passed())
        rows.push_back(verdict.passed() ? HudRow{tr("Task"), tr("passed"), HudTone::kGood}
                                        : HudRow{tr("Task"), tr("not passed"), HudTone::kAlarm});
    if (verdict.has_score_percent())
        rows.push_back({tr("Score"), tr("{1} of 100", {readableText(verdict.score_percent(), "")})});
}

std::vector<HudRow> rowsOf(const topics::Attempt& attempt) {
    if (attempt.is_exam())
        return {{tr("Time"), clockText(attempt.time_s())}, {tr("Result"), tr("an examination tells none")}};
    std::vector<HudRow> rows{{tr("Time"), clockText(attempt.time_s())},
                             {tr("Removed"), readableText(attempt.removed_mm3(), " mm\u00b3")},
                             {tr("Highest force"), readableText(attempt.max_force_n(), " N")},
                             touchedRow(attempt)};
    topics::Training figures = attempt.training();
    figures.clear_warnings();
    for (HudRow& row : trainingRows(figures)) rows.push_back(std::move(row));
    addVerdict(attempt.verdict(), rows);
    return rows;
}

// A window of this width at this part of a picture of this width, which is also the part of itself that lies
// there.
void place(float x, float y, float width, float picture_width) {
    const ImVec2 picture(picture_width, ImGui::GetIO().DisplaySize.y);
    const auto inside = [](float part, float size, float margin) {
        return margin + part * (size - 2 * margin);
    };
    ImGui::SetNextWindowPos(ImVec2(inside(x, picture.x, kCardMargin), inside(y, picture.y, kCardMargin)),
                            ImGuiCond_Always, ImVec2(x, y));
    if (width > 0) ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, picture.y * 0.6f));
}

}  // namespace

void LessonCards::build() {
    buildTop();
    if (const topics::Attempt* attempt = draft_.summary(session_)) buildSummary(*attempt);
    if (!controls_.isPanelOpen()) buildHandle();
}

void LessonCards::buildTop() {
    const topics::Lesson& lesson = *session_.lesson;
    const topics::SceneChoice* const scene = sceneOf(lesson, lesson.scene_id());
    const bool is_changing = !lesson.changing_to().empty();
    const std::optional<double> attempt_s = draft_.attemptTime();
    const float task_opacity = scene && !scene->task().empty() ? draft_.taskOpacity(session_.time_s) : 0;
    if (!is_changing && !attempt_s && task_opacity <= 0) return;
    const bool is_clock_alone = !is_changing && task_opacity <= 0;
    const float width = std::min(kCardWidth * 1.4f * scale_, view_width_ * kWidestCard);
    place(0.5f, 0, is_clock_alone ? 0 : width, view_width_);
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, is_changing || attempt_s ? 1 : task_opacity);
    ImGui::Begin(is_clock_alone ? "##clock" : "##task", nullptr, kCard | ImGuiWindowFlags_NoInputs);
    if (!is_clock_alone) ImGui::PushTextWrapPos();
    if (attempt_s) sayClock(*attempt_s);
    if (is_changing) {
        const topics::SceneChoice* const next = sceneOf(lesson, lesson.changing_to());
        const char* const text =
            next && next->is_made_first()
                ? trMark("Changing to {1}, whose bone is made first: some seconds \u2026")
                : trMark("Changing to {1} \u2026");
        ImGui::TextUnformatted(tr(text, {sceneTitle(lesson, lesson.changing_to())}).c_str());
    } else if (!is_clock_alone) {
        ImGui::TextColored(colourOfCard(kHudLabelColour), "%s", sceneTitle(lesson, scene->id()).c_str());
        ImGui::TextUnformatted(scene->task().c_str());
    }
    if (!is_clock_alone) ImGui::PopTextWrapPos();
    ImGui::End();
    ImGui::PopStyleVar();
}

void LessonCards::sayClock(double attempt_s) {
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    const std::string clock = clockText(attempt_s);
    ImGui::Text("%s   %s", session_.lesson->trainee().c_str(),
                is_paused ? tr("{1}, paused", {clock}).c_str() : clock.c_str());
}

void LessonCards::buildSummary(const topics::Attempt& attempt) {
    place(0, 1, std::min(kCardWidth * scale_, view_width_ * kWidestCard), view_width_);
    ImGui::Begin("##summary", nullptr, kCard);
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(
        tr("Attempt {1}: {2}", {std::to_string(attempt.number()), attempt.trainee()}).c_str());
    ImGui::TextColored(colourOfCard(kHudLabelColour), "%s",
                       sceneTitle(*session_.lesson, attempt.scene_id()).c_str());
    for (const HudRow& row : rowsOf(attempt)) {
        ImGui::PushTextWrapPos(ImGui::GetWindowWidth() * 0.49f);
        ImGui::TextColored(colourOfCard(kHudLabelColour), "%s", row.label.c_str());
        ImGui::PopTextWrapPos();
        ImGui::SameLine(ImGui::GetWindowWidth() * 0.5f);
        ImGui::TextColored(colourOfCard(colourOf(row.tone)), "%s", row.value.c_str());
    }
    ImGui::PopTextWrapPos();
    if (button(tr("Close"))) draft_.closeSummary();
    if (const std::string stem = resultStemOf(attempt, session_); !stem.empty()) {
        if (nextButton(tr("Report"))) wishes_.open_file = stem + ".html";
        if (session_.has_launcher && nextButton(tr("Replay"))) wishes_.replay_of = stem + ".json";
    }
    if (nextButton(tr("All attempts as CSV"))) wishes_.save_attempts = true;
    ImGui::End();
}

// The mouse alone opens the panel here, at the same place whatever stands beside the view.
void LessonCards::buildHandle() {
    place(1, 0.5f, 0, ImGui::GetIO().DisplaySize.x);
    ImGui::Begin("##lesson", nullptr, kCard);
    if (button(panelTitle(session_).c_str())) controls_.act(Action::kPanel, session_, wishes_);
    ImGui::End();
}

// Beside the button before it, or below it where the card has no more room.
bool LessonCards::nextButton(const char* label) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float left = ImGui::GetItemRectMax().x + style.ItemSpacing.x - ImGui::GetWindowPos().x;
    const float width = ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x;
    if (left + width <= ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    return button(label);
}

bool LessonCards::button(const char* label) {
    const bool is_pressed = ImGui::Button(label);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places_[label] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
    return is_pressed;
}

}  // namespace bonemill
