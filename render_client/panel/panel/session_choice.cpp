#include "render_client/panel/panel/session_choice.h"

#include <imgui.h>

namespace bonemill {
namespace {

constexpr float kChoiceHeight = 0.82f;  // of the picture: below the page that says what the viewer waits for

}  // namespace

void buildSessionChoice(const SessionView& session, Wishes& wishes, std::map<std::string, PixelPoint>& places,
                        float scale) {
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(picture.x / 2, picture.y * kChoiceHeight), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(picture.x * 0.9f, picture.y * 0.3f));
    ImGui::Begin("##sessions", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    ImGui::TextUnformatted("There are several sessions. Click one, or press its number:");
    ImGui::Dummy(ImVec2(0, 2 * scale));
    for (size_t n = 0; n < session.offered.size(); ++n) {
        const std::string label = std::to_string(n + 1) + "   " + session.offered[n].text;
        if (ImGui::Button(label.c_str())) wishes.session = session.offered[n].number;
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        places[session.offered[n].text] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
    }
    ImGui::End();
}

std::optional<uint32_t> sessionOfKey(const WindowEvent& event, const SessionView& session) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (!key || !key->is_down) return std::nullopt;
    const int n = int(key->key) - int(keyOf('1'));
    if (n < 0 || n > 8 || size_t(n) >= session.offered.size()) return std::nullopt;
    return session.offered[size_t(n)].number;
}

}  // namespace bonemill
