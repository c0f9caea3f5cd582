// Here is the panel's part in which a recorded session goes on otherwise.
#include <imgui.h>

#include <cstdio>

#include "render_client/language/language.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kLargestShift = 5, kSlowest = 0.25F, kFastest = 4;  // mm, times

std::string numberText(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", double(value));
    return text;
}

// As `bonemill what-if` takes it; empty while nothing is otherwise.
std::vector<std::string> wordsOf(const WhatIfDraft& draft) {
    std::vector<std::string> words;
    const Eigen::Vector3f& shift = draft.shift_mm;
    if (!shift.isZero())
        words.insert(words.end(), {"--shift-mm", numberText(shift.x()) + "," + numberText(shift.y()) + "," +
                                                     numberText(shift.z())});
    if (draft.tool > 0) words.insert(words.end(), {"--tool", std::to_string(draft.tool)});
    if (draft.pace != 1) words.insert(words.end(), {"--pace", numberText(draft.pace)});
    return words;
}

}  // namespace

void PanelContent::buildWhatIf() {
    WhatIfDraft& draft = what_if_draft_;
    gap();
    sayQuietly(tr("What if, from this moment on, ..."));
    if (session_.info && session_.info->tool_names_size() > 1) {
        std::string names = std::string(tr("the same tool")) + '\0';
        for (const std::string& tool : session_.info->tool_names()) names += tool + '\0';
        ImGui::Combo("##what if tool", &draft.tool, names.c_str());
        note("What if tool", tr("The burr with which it goes on"));
    }
    ImGui::SliderFloat3("mm##what if", draft.shift_mm.data(), -kLargestShift, kLargestShift, "%.2f",
                        ImGuiSliderFlags_AlwaysClamp);
    note("What if shift", tr("The hand, so many mm along x, y and z; Ctrl and a click: type"));
    ImGui::SliderFloat((tr("times as fast") + std::string("##what if")).c_str(), &draft.pace, kSlowest,
                       kFastest, "%.2f", ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    note("What if pace", tr("The hand on its way"));
    const std::vector<std::string> words = wordsOf(draft);
    ImGui::BeginDisabled(words.empty());
    if (button(tr("Go on otherwise"),
               tr("Judges it beside what happened, and shows both in a window of their own")))
        wishes_.what_if = words;
    ImGui::EndDisabled();
}

}  // namespace bonemill
