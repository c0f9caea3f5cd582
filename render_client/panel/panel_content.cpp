#include "render_client/panel/panel_content.h"

#include <imgui.h>

#include <algorithm>
#include <iterator>

#include "render_client/controls/accuracy_keys.h"
#include "render_client/hud/effect_lines.h"
#include "render_client/hud/hud_colours.h"
#include "render_client/hud/session_text.h"

namespace bonemill {
namespace {

constexpr float kWidth = 330;  // pixels at scale 1
constexpr float kMargin = 14;  // to the picture's edge
constexpr double kLeastOpacity = 0.05;

ImVec4 imColour(const HudColour& colour) {
    return {colour[0], colour[1], colour[2], colour[3]};
}

const ImVec4 kQuiet = imColour(kHudLabelColour);
const ImVec4 kWarning = imColour(colourOf(HudTone::kWarning));

bool isOpen(const char* title) {
    return ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen);
}

void gap() {
    ImGui::Dummy(ImVec2(0, ImGui::GetStyle().ItemSpacing.y));
}

}  // namespace

void PanelContent::build() {
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    const float width = std::min(kWidth * scale_, picture.x), margin = kMargin * scale_;
    ImGui::SetNextWindowPos(ImVec2(picture.x - margin, margin), ImGuiCond_Always, ImVec2(1, 0));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, picture.y - 2 * margin));
    ImGui::Begin("Controls (M)", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    if (isOpen("View")) buildView();
    gap();
    buildEffects();
    if (isOpen("Session")) buildSession();
    if (session_.status && session_.status->has_training()) {
        gap();
        if (isOpen("Training")) buildTraining();
    }
    gap();
    if (isOpen("Who is watching")) buildWatchers();
    ImGui::End();
}

void PanelContent::note(const char* label, const char* what) {
    // A box's label belongs to it, but its left end is always the control.
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 place(low.x + (high.y - low.y) / 2, (low.y + high.y) / 2);
    if (ImGui::IsRectVisible(place, ImVec2(place.x + 1, place.y + 1))) places_[label] = {place.x, place.y};
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", what);
}

bool PanelContent::button(const char* label, const char* what) {
    const bool is_pressed = ImGui::Button(label);
    note(label, what);
    return is_pressed;
}

bool PanelContent::box(const char* label, bool is_on, const char* what) {
    const bool is_changed = ImGui::Checkbox(label, &is_on);
    note(label, what);
    return is_changed;
}

bool PanelContent::choice(const char* label, bool is_chosen, const char* what) {
    const bool is_pressed = ImGui::RadioButton(label, is_chosen);
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

void PanelContent::buildView() {
    if (button("First view (R)", "Back to the view that the scene starts with")) act(Action::kFirstView);
    buildSides();
    if (box("Endoscope (E)", settings_.camera == CameraMode::kEndoscope,
            "Looks along the tool past its burr, instead of from around the bone"))
        act(Action::kEndoscope);
    gap();
    if (box("Transparent (T)", settings_.is_transparent, "Bone lets the tool and inner walls through"))
        act(Action::kTransparency);
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    if (const auto opacity =
            slider("##opacity", settings_.opacity, kLeastOpacity, "How dense the transparent bone is"))
        controls_.setOpacity(*opacity);
    ImGui::PopItemWidth();
    gap();
    buildCuts();
    gap();
    buildStereo();
    gap();
    if (box("Force arrow (F)", settings_.show_force, "The contact force on the hand, at the burr"))
        act(Action::kForceArrow);
    ImGui::SameLine();
    if (box("Quick drawing (Q)", settings_.quality == Quality::kQuick,
            "Without shadows and smooth edges: for PCs without a graphics card"))
        act(Action::kQuickDrawing);
    if (box("Figures (Tab)", settings_.show_hud, "What is written over the picture")) act(Action::kHud);
    ImGui::SameLine();
    if (box("Watchers (W)", settings_.show_watchers, "Who is watching, over the picture"))
        act(Action::kWatchers);
    ImGui::SameLine();
    if (box("Help (H)", settings_.show_help, "All keys, over the picture")) act(Action::kHelp);
}

void PanelContent::buildSides() {
    constexpr struct {
        const char* label;
        Side side;
        const char* what;
    } kSides[] = {{"Front", Side::kFront, "From the patient's front"},
                  {"Back", Side::kBack, "From the patient's back"},
                  {"Left", Side::kLeft, "From the patient's left"},
                  {"Right", Side::kRight, "From the patient's right"},
                  {"Top", Side::kTop, "From above the patient's head"},
                  {"Below", Side::kBottom, "From the patient's feet"}};
    for (const auto& side : kSides) {
        if (side.side != Side::kFront) ImGui::SameLine();
        if (button(side.label, side.what)) controls_.lookFrom(side.side);
    }
}

void PanelContent::buildCuts() {
    constexpr struct {
        const char* label;
        const char* flip;
        const char* position;
        const char* what;
    } kCuts[] = {{"Cut X", "Flip##x", "##cut x", "Sagittal plane: hides the bone on the patient's left"},
                 {"Cut Y", "Flip##y", "##cut y", "Coronal plane: hides the bone at the back"},
                 {"Cut Z", "Flip##z", "##cut z", "Axial plane: hides the bone above"}};
    for (size_t axis = 0; axis < std::size(kCuts); ++axis) {
        const auto& cut = kCuts[axis];
        const CutPlane& plane = settings_.cuts[axis];
        if (box(cut.label, plane.is_on, cut.what)) act(Action(int(Action::kCutX) + int(axis)));
        ImGui::SameLine();
        if (box(cut.flip, plane.is_flipped, "Hides the other side"))
            act(Action(int(Action::kFlipX) + int(axis)));
        ImGui::SameLine();
        ImGui::PushItemWidth(-1);
        if (const auto position =
                slider(cut.position, plane.position, 0, "Where the plane is, across the bone"))
            controls_.moveCutTo(axis, *position);
        ImGui::PopItemWidth();
    }
}

void PanelContent::buildStereo() {
    const auto offer = [this](const char* label, StereoMode mode, const char* what) {
        if (choice(label, settings_.stereo == mode, what)) controls_.setStereo(mode);
    };
    ImGui::TextColored(kQuiet, "Stereo (S)");
    offer("Off", StereoMode::kOff, "One picture");
    ImGui::SameLine();
    offer("Side by side", StereoMode::kSideBySide, "The left eye's picture beside the right eye's");
    ImGui::SameLine();
    offer("Red/cyan", StereoMode::kAnaglyph, "For glasses with a red and a cyan lens");
}

// Only those that the scene lists.
void PanelContent::buildEffects() {
    const scene::Effects none;
    const scene::Effects& listed = session_.info ? session_.info->viewer_effects() : none;
    const struct {
        const char* label;
        ViewerEffect effect;
        bool is_listed;
        const char* what;
    } effects[] = {
        {"Bone dust", ViewerEffect::kBoneDust, listed.has_bone_dust(), "Grains that leave the burr"},
        {"Bleeding", ViewerEffect::kBleeding, listed.has_bleeding(), "Blood on fresh cuts"},
        {"Irrigation", ViewerEffect::kIrrigation, listed.has_irrigation(), "Water, while the pedal is down"},
        {"Burr spin", ViewerEffect::kBurrSpin, listed.has_burr_spin(), "Flutes that turn"},
        {"Milling sound", ViewerEffect::kMillingSound, listed.has_milling_sound(),
         "Motor and cutting, heard here"}};
    if (std::ranges::none_of(effects, [](const auto& e) { return e.is_listed; })) return;
    if (isOpen("Effects"))
        for (const auto& e : effects) {
            const bool is_shown = settings_.shows(e.effect);
            if (e.is_listed && box(e.label, is_shown, e.what)) controls_.showEffect(e.effect, !is_shown);
        }
    gap();
}

void PanelContent::buildSession() {
    const std::string why_not = whyNotCommand(session_);
    if (!why_not.empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(kWarning, "%s", why_not.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::BeginDisabled(!why_not.empty());
    const bool is_paused = session_.status && session_.status->is_milling_paused();
    if (box("Pause milling (P)", is_paused, "The tool still feels the bone but removes nothing"))
        act(Action::kPauseMilling);
    if (button("Put the bone back (C)", "Everything that was removed is there again"))
        act(Action::kResetBone);
    gap();
    buildCheckpoints();
    gap();
    buildTools();
    gap();
    buildAccuracy();
    ImGui::EndDisabled();
    gap();
    buildEnd();
}

void PanelContent::buildCheckpoints() {
    if (button("Save a checkpoint (K)", "Keeps the bone as it is now, to come back to it"))
        act(Action::kSaveCheckpoint);
    if (!session_.status || session_.status->checkpoints().empty()) {
        ImGui::TextColored(kQuiet, "no checkpoint yet");
        return;
    }
    const auto& checkpoints = session_.status->checkpoints();
    for (auto checkpoint = checkpoints.rbegin(); checkpoint != checkpoints.rend(); ++checkpoint) {
        const std::string label = "Back to " + std::to_string(checkpoint->id());
        const bool is_last = checkpoint == checkpoints.rbegin();
        if (button(label.c_str(), is_last ? "The bone as it was at the last checkpoint (U)"
                                          : "The bone as it was at this checkpoint")) {
            topics::Command command;
            command.set_restore_checkpoint(checkpoint->id());
            send(std::move(command));
        }
        ImGui::SameLine();
        ImGui::Text("%s", clockText(checkpoint->session_s()).c_str());
        ImGui::SameLine();
        ImGui::TextColored(kQuiet, "%.1f mm\u00b3 removed", checkpoint->removed_mm3());
    }
}

void PanelContent::buildTools() {
    ImGui::TextColored(kQuiet, "Tool (N: the next one)");
    const int count = session_.info ? session_.info->tool_names_size() : 0;
    if (count == 0) ImGui::TextUnformatted("the scene's only one");
    for (int i = 0; i < count; ++i) {
        const std::string label = session_.info->tool_names(i) + "##tool " + std::to_string(i);
        if (!choice(label.c_str(), session_.info->tool_index() == uint32_t(i),
                    "Puts this tool into the hand"))
            continue;
        topics::Command command;
        command.set_select_tool(uint32_t(i));
        send(std::move(command));
    }
}

void PanelContent::buildAccuracy() {
    ImGui::TextColored(kQuiet, "Accuracy (keys 0 to 4)");
    const std::string in_force = session_.status ? session_.status->preset() : "";
    for (size_t key = 1; key < std::size(kAccuracyOfKey); ++key) {
        const std::string name(kAccuracyOfKey[key]);
        if (key % 2 == 0) ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.5f);
        if (choice(name.c_str(), in_force == name, "How finely contact and force are computed"))
            act(Action(int(Action::kAccuracyScene) + int(key)));
    }
    if (button("As the scene file says (0)", "The accuracy that the scene starts with"))
        act(Action::kAccuracyScene);
}

void PanelContent::buildEnd() {
    const std::string why_not = whyNotEndSession(session_);
    ImGui::BeginDisabled(!why_not.empty());
    if (!is_ending_) {
        is_ending_ =
            button("End the session", why_not.empty() ? "Stops the server, for everybody" : why_not.c_str());
    } else {
        ImGui::TextColored(kWarning, "End it for everybody?");
        ImGui::SameLine();
        if (button("End", "Stops the server")) {
            topics::Command command;
            command.set_shut_down(true);
            send(std::move(command));
            is_ending_ = false;
        }
        ImGui::SameLine();
        if (button("Go on", "Nothing is stopped")) is_ending_ = false;
    }
    ImGui::EndDisabled();
}

void PanelContent::buildTraining() {
    for (const HudRow& row : trainingRows(session_.status->training())) {
        if (!row.label.empty()) {
            ImGui::TextColored(kQuiet, "%s", row.label.c_str());
            ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.55f);
        }
        ImGui::TextColored(imColour(colourOf(row.tone)), "%s", row.value.c_str());
    }
}

void PanelContent::buildWatchers() {
    const auto row = [](const std::string& name, topics::Viewer::Role role, double rate_hz,
                        bool is_complete) {
        ImGui::Text("%s", name.empty() ? "(no name)" : name.c_str());
        ImGui::SameLine();
        ImGui::TextColored(kQuiet, "%s, %.*f pictures/s%s", roleName(role).c_str(), rate_hz < 10 ? 1 : 0,
                           rate_hz, is_complete ? "" : ", incomplete");
    };
    row(session_.name + " (you)", session_.role, session_.frame_rate_hz, session_.is_complete);
    for (const topics::Viewer& other : session_.others)
        row(other.name(), other.role(), other.frame_rate_hz(), other.is_complete());
}

}  // namespace bonemill
