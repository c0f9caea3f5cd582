#include "render_client/panel/panel/panel_content.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "common/commands/role_rules.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

ImVec4 imColour(const HudColour& colour) {
    return {colour[0], colour[1], colour[2], colour[3]};
}

}  // namespace

void PanelContent::build() {
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    const float width = std::min(kWidth * scale_, view_width_), margin = kMargin * scale_;
    ImGui::SetNextWindowPos(ImVec2(view_width_ - margin, margin), ImGuiCond_Always, ImVec2(1, 0));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, picture.y - 2 * margin));
    ImGui::Begin((title() + "###panel").c_str(), nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    if (std::exchange(draft_.scrolls_to_top, false)) ImGui::SetScrollY(0);
    bool is_first = true;
    const auto section = [&](bool is_there, const char* name, void (PanelContent::*build_it)()) {
        if (!is_there) return;
        if (!std::exchange(is_first, false)) gap();
        if (isPartOpen(name, true)) (this->*build_it)();
    };
    using Content = PanelContent;
    section(controls_.toolHold().isHolding() || isHeldByMouse(session_), trMark("Tool in the mouse"),
            &Content::buildHold);
    section(isReplay(session_), trMark("Replay"), &Content::buildReplay);
    section(session_.lesson && session_.lesson->scenes_size() > 0, trMark("Lesson"), &Content::buildLesson);
    section(session_.has_launcher && session_.past && !session_.past->empty(), trMark("Last sessions"),
            &Content::buildPast);
    section(true, trMark("View"), &Content::buildView);
    section(hasStructures(), trMark("Structures"), &Content::buildStructures);
    section(hasEffects(), trMark("Effects"), &Content::buildEffects);
    section(true, trMark("Session"), isReplay(session_) ? &Content::buildEnd : &Content::buildSession);
    section(session_.status && session_.status->has_training(), trMark("Training"), &Content::buildTraining);
    section(!session_.faults.empty(), trMark("Faults"), &Content::buildFaults);
    section(true, trMark("Notes and strokes"), &Content::buildRemarks);
    section(true, trMark("Who is watching"), &Content::buildWatchers);
    section(session_.has_launcher && !isReplay(session_), trMark("Invite a colleague"),
            &Content::buildInvite);
    if (session_.info && session_.status && !isReplay(session_) &&
        mayOrder(session_.role, topics::Command::kTune)) {
        gap();
        if (isPartOpen(trMark("Tuning"), false)) buildTuning();
        note(tr("Tuning"), tr("Stiffness, damping and limits of the contact law, while the session runs"));
    }
    if (session_.tool) {
        gap();
        if (isPartOpen(trMark("Plots"), false)) buildPlots();  // for the lab
        note(tr("Plots"), tr("Force, torque and the tick's work over the last 10 s"));
    }
    ImGui::End();
}

bool PanelContent::isPartOpen(const char* name, bool is_open_at_first) {
    bool& is_open = folds_.try_emplace(name, is_open_at_first).first->second;
    ImGui::SetNextItemOpen(is_open);
    return is_open = ImGui::CollapsingHeader(tr(name));
}

// The button that opens the panel is called so, too.
std::string PanelContent::title() const {
    return panelTitle(session_);
}

void PanelContent::gap() {
    ImGui::Dummy(ImVec2(0, ImGui::GetStyle().ItemSpacing.y));
}

void PanelContent::sayQuietly(const std::string& text) {
    ImGui::TextColored(imColour(kHudLabelColour), "%s", text.c_str());
}

void PanelContent::say(const std::string& text, HudTone tone) {
    ImGui::TextColored(imColour(colourOf(tone)), "%s", text.c_str());
}

void PanelContent::sayWrapped(const std::string& text, HudTone tone) {
    ImGui::PushTextWrapPos();
    say(text, tone);
    ImGui::PopTextWrapPos();
}

void PanelContent::note(const std::string& label, const char* what) {
    // A box's label belongs to it, but its left end is always the control.
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 place(low.x + (high.y - low.y) / 2, (low.y + high.y) / 2);
    if (ImGui::IsRectVisible(place, ImVec2(place.x + 1, place.y + 1))) places_[label] = {place.x, place.y};
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) explain(what);
}

// It stands beside the panel, where it covers none of the neighbours.
void PanelContent::explain(const std::string& text) {
    constexpr float kWidest = 22;  // letters' heights
    const ImVec2 panel = ImGui::GetWindowPos();
    const float widest = std::min(kWidest * ImGui::GetFontSize(), panel.x - 4 * scale_);
    if (widest > 6 * ImGui::GetFontSize())
        ImGui::SetNextWindowPos(ImVec2(panel.x - 4 * scale_, ImGui::GetItemRectMin().y), ImGuiCond_Always,
                                ImVec2(1, 0));
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(std::max(widest, 12 * ImGui::GetFontSize()));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool PanelContent::button(const std::string& label, const char* what) {
    const bool is_pressed = ImGui::Button(label.c_str());
    note(label, what);
    return is_pressed;
}

bool PanelContent::box(const std::string& label, bool is_on, const char* what) {
    const bool is_changed = ImGui::Checkbox(label.c_str(), &is_on);
    note(label, what);
    return is_changed;
}

bool PanelContent::choice(const std::string& label, bool is_chosen, const char* what) {
    const bool is_pressed = ImGui::RadioButton(label.c_str(), is_chosen);
    note(label, what);
    return is_pressed && !is_chosen;
}

std::optional<double> PanelContent::slider(const char* label, double fraction, double least,
                                           const char* what) {
    auto percent = float(fraction * 100);
    const bool is_moved =
        ImGui::SliderFloat(label, &percent, float(least * 100), 100, "%.0f %%", ImGuiSliderFlags_AlwaysClamp);
    note(label, what);
    return is_moved ? std::optional(double(percent) / 100) : std::nullopt;
}

void PanelContent::button(const char* text, Action action, const char* what) {
    if (button(withKey(text, action), what)) act(action);
}

void PanelContent::buttonBeside(const char* text, Action action, const char* what) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(withKey(text, action).c_str()).x + 2 * style.FramePadding.x;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= right) ImGui::SameLine();
    button(text, action, what);
}

void PanelContent::box(const char* text, Action action, bool is_on, const char* what) {
    if (box(withKey(text, action), is_on, what)) act(action);
}

}  // namespace bonemill
