// Here is the panel's part that tunes the contact law while the session runs.
#include <imgui.h>

#include <algorithm>
#include <cctype>

#include "common/config/live_fields.h"
#include "proto/scene.pb.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr double kWidest = 8;  // a slider goes to so many times what the scene file says, and to that part

// What a scene file says of the accuracy that is in force; empty for knobs that no preset has.
std::string accuracyText(const std::string& in_force) {
    std::string name = in_force;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    scene::Accuracy::Preset preset{};
    return scene::Accuracy::Preset_Parse(name, &preset) ? "accuracy { preset: " + name + " }" : "";
}

}  // namespace

std::string sceneTextOf(const topics::Status& status) {
    std::string text = tuningText(status.tuning());
    const std::string accuracy = accuracyText(status.preset());
    return text + (text.empty() || accuracy.empty() ? "" : "\n") + accuracy;
}

void PanelContent::buildTuning() {
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) sayWrapped(why_not, HudTone::kWarning);
    ImGui::BeginDisabled(!why_not.empty());
    for (const LiveField& field : liveFields()) buildTuned(field);
    if (button(tr("As the scene file"), tr("Nothing is tuned any more"))) tune({});
    ImGui::EndDisabled();
    const std::string text = sceneTextOf(*session_.status);
    if (text.empty()) return;
    gap();
    sayWrapped(text, HudTone::kPlain);
    if (button(tr("Copy"), tr("The lines above into the clipboard, for the scene file"))) wishes_.copy = text;
}

// It is ordered when the slider is let go: each order is a tuning of its own.
void PanelContent::buildTuned(const LiveField& field) {
    const double own = valueOf(session_.info->tunable(), field).value_or(0);
    const std::string path = field.path();
    double value = valueOf(session_.status->tuning(), field).value_or(own);
    if (tuning_draft_.path == path) value = tuning_draft_.value;
    const scene::Range bounds = boundsOf(field, session_.info->tunable());
    const double low = std::max(bounds.min(), own / kWidest);
    const double high = own > 0 ? std::min(bounds.max(), own * kWidest) : bounds.max();
    sayQuietly(path);
    ImGui::PushItemWidth(-1);
    ImGui::SliderScalar(("##" + path).c_str(), ImGuiDataType_Double, &value, &low, &high,
                        ("%.4g " + field.unit()).c_str(),
                        ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopItemWidth();
    const bool is_dragged = ImGui::IsItemActive(), is_done = ImGui::IsItemDeactivatedAfterEdit();
    note(path, (tr("The scene file says {1}", {readableText(own, (" " + field.unit()).c_str())})).c_str());
    if (is_dragged)
        tuning_draft_ = {path, value};
    else if (tuning_draft_.path == path)
        tuning_draft_ = {};
    if (!is_done) return;
    scene::Tuning wanted = session_.status->tuning();
    setValue(wanted, field, value);
    tune(wanted);
}

void PanelContent::tune(const scene::Tuning& tuning) {
    topics::Command command;
    *command.mutable_tune() = tuning;
    send(command);
}

}  // namespace bonemill
