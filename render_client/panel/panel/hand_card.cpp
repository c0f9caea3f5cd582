#include "render_client/panel/panel/hand_card.h"

#include <imgui.h>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

// Letters' heights from the picture's lower edge: between the sentences and the notices of hud_layout.cpp.
constexpr float kAboveEdge = 4;

struct CardButton {
    const char* text;
    Action action;
    const char* what;
};
constexpr CardButton kButtons[] = {
    {trMark("Again"), Action::kAgain,
     trMark("The bone is put back, and the hand does its script from the beginning")},
    {trMark("Take over"), Action::kHoldTool, trMark("The tool comes to your mouse")}};

}  // namespace

bool isHandCardOnScreen(const SessionView& session) {
    return hasHandEnded(session) && whyNotTakeOver(session).empty();
}

void buildHandCard(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                   std::map<std::string, PixelPoint>& places, float scale, float view_width) {
    const float bottom = ImGui::GetIO().DisplaySize.y - kAboveEdge * ImGui::GetFontSize();
    ImGui::SetNextWindowPos(ImVec2(view_width / 2, bottom), ImGuiCond_Always, ImVec2(0.5f, 1));
    ImGui::Begin("##hand", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus);
    bool is_first = true;
    for (const CardButton& button : kButtons) {
        if (!is_first) ImGui::SameLine(0, 10 * scale);
        is_first = false;
        const std::string label = withKey(tr(button.text), button.action);
        if (ImGui::Button(label.c_str())) controls.act(button.action, session, wishes);
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        places[label] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr(button.what));
    }
    ImGui::End();
}

}  // namespace bonemill
