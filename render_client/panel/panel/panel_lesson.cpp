// Here is the panel's part about a lesson: scenes to choose from, the trainee, and how the attempts went.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "common/attempts_csv/attempts_csv.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kFolded = 0.5f;  // of the picture, where the text is folded
constexpr int kRowsOfTable = 4;
constexpr float kColumnWidth = 4.3f;  // letters' heights

constexpr struct {
    const char* title;
    const char* what;
} kColumns[] = {
    {trMark("Trainee,\nexercise"), trMark("Who tried, and what")},
    {trMark("Time,\nremoved"), trMark("Time without pauses; bone that was removed")},
    {trMark("Force,\ndistance"),
     trMark("Highest force on the hand; least distance to a protected structure")},
    {trMark("Damage,\nscore"), trMark("Volume of protected structures that was damaged; score of 100")}};

std::string detailsOf(const topics::SceneChoice& scene) {
    std::string text;
    for (const std::string& tool : scene.tools()) text += (text.empty() ? "" : ", ") + tool;
    if (scene.expected_s() > 0)
        text += (text.empty() ? "" : "; ") +
                tr("about {1} min", {std::to_string(std::max(1l, std::lround(scene.expected_s() / 60)))});
    return text;
}

}  // namespace

void PanelContent::buildLesson() {
    const topics::Lesson& lesson = *session_.lesson;
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) sayWrapped(why_not, HudTone::kWarning);
    ImGui::BeginDisabled(!why_not.empty());
    buildTrainee(lesson);
    ImGui::EndDisabled();
    if (!lesson.attempts().empty()) {
        gap();
        buildAttempts(lesson);
    }
    gap();
    ImGui::BeginDisabled(!why_not.empty());
    sayQuietly(tr("Exercise ({1}: the next one)", {keyLabelOf(Action::kNextScene)}));
    for (const topics::SceneChoice& scene : lesson.scenes()) buildScene(lesson, scene);
    ImGui::EndDisabled();
}

void PanelContent::buildTrainee(const topics::Lesson& lesson) {
    if (draft_.wants_keyboard) ImGui::SetKeyboardFocusHere();
    draft_.wants_keyboard = false;
    ImGui::PushItemWidth(-1);
    const bool is_entered = ImGui::InputTextWithHint(
        "##trainee", withKey(tr("Trainee's name or number"), Action::kTrainee).c_str(), draft_.trainee.data(),
        draft_.trainee.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    note("##trainee", tr("Who tries; Enter starts the attempt"));
    ImGui::PopItemWidth();
    if (is_entered) draft_.has_entered = draft_.wants_keyboard = true;
    const bool is_started =
        button(tr("Start"), tr("On whole bone, with the clock at zero; an attempt under way ends")) ||
        is_entered;
    if (is_started) startAttempt(lesson);
    ImGui::SameLine();
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    button(is_paused ? tr("Go on") : tr("Pause"), Action::kPauseMilling,
           tr("The clock of the attempt rests, too"));
    ImGui::BeginDisabled(!lesson.is_running());
    button(tr("Stop"), Action::kStopAttempt, tr("Ends the attempt, and shows how it went"));
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (button(tr("Next trainee"), tr("Ends an attempt under way, and asks for the next name")))
        controls_.want({Deed::Kind::kNextTrainee}, session_, wishes_);
    if (lesson.is_running()) say(tr("{1} is at it", {lesson.trainee()}), HudTone::kGood);
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

// Only the scene in force is told of in full; of the others the mouse that rests on one asks.
void PanelContent::buildScene(const topics::Lesson& lesson, const topics::SceneChoice& scene) {
    const bool is_chosen = scene.id() == lesson.scene_id(), is_possible = scene.problem().empty();
    const std::string title = sceneTitle(lesson, scene.id()), details = detailsOf(scene);
    ImGui::PushID(scene.id().c_str());
    ImGui::BeginGroup();
    showPicture(scene.id(), is_chosen ? 1 : kFolded);
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::BeginDisabled(!is_possible);
    ImGui::RadioButton(title.c_str(), is_chosen);
    ImGui::EndDisabled();
    ImGui::PushTextWrapPos();
    if (is_chosen && !scene.task().empty()) say(scene.task(), HudTone::kPlain);
    if (is_chosen && !details.empty()) sayQuietly(details);
    if (!is_possible) say(scene.problem(), HudTone::kWarning);
    if (scene.is_made_first()) sayQuietly(tr("A click makes its bone first: some seconds"));
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    ImGui::EndGroup();
    if (isRowClicked(title) && is_possible && !is_chosen && whyNotCommand(session_).empty()) {
        topics::Command command;
        command.set_choose_scene(scene.id());
        send(command);
    }
    if (!is_chosen && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        explain(title + "\n" + scene.task() + "\n" + details);
    ImGui::PopID();
}

// The last group is a row, which is clicked wherever the mouse goes down and up in it.
bool PanelContent::isRowClicked(const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
    const ImVec2 high(ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x, end.y);
    const ImVec2 place(low.x + 4 * scale_, low.y + 4 * scale_);
    if (ImGui::IsRectVisible(place, ImVec2(place.x + 1, place.y + 1))) places_[name] = {place.x, place.y};
    const ImVec2 pressed = ImGui::GetIO().MouseClickedPos[0];
    const bool began_here =
        pressed.x >= low.x && pressed.x < high.x && pressed.y >= low.y && pressed.y < high.y;
    return ImGui::IsMouseReleased(0) && began_here && ImGui::IsMouseHoveringRect(low, high) &&
           ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
}

void PanelContent::buildAttempts(const topics::Lesson& lesson) {
    sayQuietly(tr("Attempts of this class"));
    const int rows = 2 * (std::min(lesson.attempts_size(), kRowsOfTable) + 1);
    const ImVec2 size(0, ImGui::GetTextLineHeight() * (float(rows) + 0.5f * float(rows) / 2));
    const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY;
    if (ImGui::BeginTable("attempts", 4, flags, size)) {
        ImGui::TableSetupScrollFreeze(0, 1);
        ImGui::TableSetupColumn("who", ImGuiTableColumnFlags_WidthStretch);
        for (const char* name : {"time", "force", "damage"})
            ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed,
                                    kColumnWidth * ImGui::GetFontSize());
        ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
        for (const auto& [title, what] : kColumns) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(tr(title));
            note(tr(title), tr(what));
        }
        for (auto attempt = lesson.attempts().rbegin(); attempt != lesson.attempts().rend(); ++attempt)
            buildAttempt(lesson, *attempt);
        ImGui::EndTable();
    }
    if (button(tr("Save as CSV"),
               tr("Writes all figures of these attempts into a file here, for a spreadsheet")))
        wishes_.save_attempts = true;
    if (session_.class_folder.empty()) return;
    ImGui::SameLine();
    if (button(tr("Class page"),
               tr("How the class did: distribution, what was failed most, each trainee's attempts")))
        wishes_.open_file = session_.class_folder + "/class.html";
    ImGui::SameLine();
    if (button(tr("Folder"), tr("Table, class page and one report for each attempt")))
        wishes_.open_file = session_.class_folder;
    sayWrapped(session_.class_folder, HudTone::kPlain);
}

void PanelContent::buildAttempt(const topics::Lesson& lesson, const topics::Attempt& attempt) {
    const topics::Training& training = attempt.training();
    const std::string scene = sceneTitle(lesson, attempt.scene_id());
    const std::string number = std::to_string(attempt.number());
    const auto cell = [](const std::string& first, const std::string& second) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted((first + "\n" + second).c_str());
    };
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string label = tr("Attempt {1}", {number});
    const ImVec2 corner = ImGui::GetCursorPos();
    if (ImGui::Selectable(("##" + label).c_str(), false, ImGuiSelectableFlags_SpanAllColumns,
                          ImVec2(0, 2 * ImGui::GetTextLineHeight())))
        draft_.showSummary(attempt.number());
    const std::string what =
        number + ". " + attempt.trainee() + ": " + scene + "\n" + tr("A click shows how it went");
    note(label, what.c_str());
    ImGui::SetCursorPos(corner);
    ImGui::TextUnformatted((number + "  " + attempt.trainee() + "\n" + scene).c_str());
    const auto unlessExam = [&](const std::string& text) { return attempt.is_exam() ? kNoNumber : text; };
    cell(clockText(attempt.time_s()), unlessExam(readableText(attempt.removed_mm3(), " mm\u00b3")));
    cell(unlessExam(readableText(attempt.max_force_n(), " N")),
         training.has_least_distance_mm() ? readableText(training.least_distance_mm(), " mm") : kNoNumber);
    cell(!training.has_damaged_mm3()  ? kNoNumber
         : training.damaged_mm3() > 0 ? readableText(training.damaged_mm3(), " mm\u00b3")
                                      : trIn("volume", "none"),
         attempt.verdict().has_score_percent() ? readableText(attempt.verdict().score_percent(), "")
                                               : kNoNumber);
}

}  // namespace bonemill
