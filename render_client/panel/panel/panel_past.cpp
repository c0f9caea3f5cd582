// Here is the panel's part about attempts of before: how they went, their reports and replays.
#include <imgui.h>

#include "render_client/language/language.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kPictureWidth = 92, kPictureHeight = 69;  // pixels at scale 1

}  // namespace

void PanelContent::buildPast() {
    for (size_t n = 0; n < session_.past->size(); ++n)
        buildPastAttempt((*session_.past)[n], std::to_string(n + 1));
}

void PanelContent::buildPastAttempt(const PastAttempt& attempt, const std::string& number) {
    showPicture(attempt.stem, 1);
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::PushTextWrapPos();
    say(attempt.scene, HudTone::kPlain);
    sayQuietly(attempt.start + "  " + attempt.trainee);
    say(attempt.score, HudTone::kPlain);
    ImGui::PopTextWrapPos();
    if (button(tr("Report") + ("##past " + number), tr("Opens the attempt's report")))
        wishes_.open_file = attempt.stem + ".html";
    if (!attempt.recording.empty()) {
        ImGui::SameLine();
        if (button(tr("Replay") + ("##past " + number),
                   tr("Shows it again in a window of its own, just before its worst moment")))
            wishes_.replay_of = attempt.stem + ".json";
    }
    ImGui::EndGroup();
}

// The place is left free where there is none.
void PanelContent::showPicture(const std::string& name, float size) {
    const ImVec2 place(kPictureWidth * scale_ * size, kPictureHeight * scale_ * size);
    const auto picture = pictures_.find(name);
    if (picture != pictures_.end() && picture->second.number > 0)
        ImGui::Image(ImTextureID(intptr_t(picture->second.number)), place);
    else
        ImGui::Dummy(place);
}

}  // namespace bonemill
