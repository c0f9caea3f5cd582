#include "render_client/panel/panel/question_box.h"

#include <imgui.h>

#include <algorithm>

#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kQuestionWidth = 400, kNarrowest = 240;  // pixels at scale 1

// The panel stays free, for who answers by the same button once more, unless the picture is too narrow.
float freeWidth(const ViewerControls& controls, float picture_width, float scale) {
    const float panel = (PanelContent::kWidth + 2 * PanelContent::kMargin) * scale;
    const bool is_free = controls.isPanelOpen() && picture_width - panel >= kNarrowest * scale;
    return is_free ? picture_width - panel : picture_width;
}

bool isAnswered(const std::string& label, std::map<std::string, PixelPoint>& places) {
    const bool is_pressed = ImGui::Button(label.c_str());
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places[label] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
    return is_pressed;
}

}  // namespace

void buildQuestion(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                   std::map<std::string, PixelPoint>& places, float scale, float view_width) {
    using Answer = ViewerControls::Answer;
    const std::optional<Question> question = controls.question(session);
    if (!question) return;
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    const float space = freeWidth(controls, view_width, scale);
    const float width = std::min(kQuestionWidth * scale, space - PanelContent::kMargin * scale);
    ImGui::SetNextWindowPos(ImVec2(space / 2, picture.y / 2), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, picture.y));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * scale, 14 * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.0f, scale));
    ImGui::PushStyleColor(ImGuiCol_Border, ImVec4(0.95f, 0.75f, 0.3f, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.06f, 0.08f, 0.1f, 1));
    ImGui::Begin("##question", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(question->text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy(ImVec2(0, 6 * scale));
    std::optional<Answer> answer;
    if (isAnswered(question->yes + " (Enter)", places)) answer = Answer::kYes;
    ImGui::SameLine();
    if (isAnswered(question->no + " (Esc)", places)) answer = Answer::kNo;
    if (question->offers_checkpoint) {
        ImGui::SameLine();
        if (isAnswered("Save a checkpoint first", places)) answer = Answer::kSaveFirst;
    }
    ImGui::End();
    ImGui::PopStyleColor(2);
    ImGui::PopStyleVar(2);
    if (answer) controls.answer(*answer, session, wishes);
}

std::optional<ViewerControls::Answer> answerOfKey(const WindowEvent& event) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (!key || !key->is_down || key->is_repeat) return std::nullopt;
    if (key->key == Key::kEnter) return ViewerControls::Answer::kYes;
    if (key->key == Key::kEscape) return ViewerControls::Answer::kNo;
    return std::nullopt;
}

}  // namespace bonemill
