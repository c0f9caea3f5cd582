// Here are the panel's parts about what is seen, view, structures and effects, and about the mouse that holds
// the tool.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/structures/structure_set.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr double kMinOpacity = 0.05;

constexpr struct {
    const char* label;
    ViewerEffect effect;
    const char* what;
} kEffects[] = {{"Bone dust", ViewerEffect::kBoneDust, "Grains that leave the burr"},
                {"Bleeding", ViewerEffect::kBleeding, "Blood on fresh cuts"},
                {"Irrigation", ViewerEffect::kIrrigation, "Water, while the pedal is down"},
                {"Burr spin", ViewerEffect::kBurrSpin, "Flutes that turn"},
                {"Milling sound", ViewerEffect::kMillingSound, "Motor and cutting, heard here"},
                {"Browning", ViewerEffect::kBrowning, "Bone that got too hot"},
                {"Bruising", ViewerEffect::kBruising, "Protected structures that were touched"},
                {"Pulse", ViewerEffect::kPulse, "Open dura and vessels rise with the heart"}};

}  // namespace

void PanelContent::buildView() {
    sayQuietly("Cut open");
    buildCuts();
    gap();
    button("First view", Action::kFirstView, "Back to the view that the scene starts with");
    buildSides();
    box("Endoscope", Action::kEndoscope, settings_.camera == CameraMode::kEndoscope,
        "Looks along the tool past its burr, instead of from around the bone");
    ImGui::SameLine();
    box("Microscope", Action::kMicroscope, settings_.camera == CameraMode::kMicroscope,
        "A round field, lit along the line of sight; the wheel magnifies");
    if (settings_.camera == CameraMode::kMicroscope &&
        box("Depth of field", settings_.has_depth_of_field, "Blurs what the microscope is not focused on"))
        controls_.setDepthOfField(!settings_.has_depth_of_field);
    gap();
    buildTransparency();
    gap();
    buildScan();
    gap();
    buildStereo();
    gap();
    buildSigns();
}

void PanelContent::buildHold() {
    const bool is_holding = controls_.toolHold().isHolding();
    const std::string why_not = is_holding ? "" : whyNotHold(session_);
    ImGui::BeginDisabled(!why_not.empty());
    box("Hold the tool", Action::kHoldTool, is_holding, "The tool follows the mouse; the left button mills");
    ImGui::EndDisabled();
    if (isTakenOver(session_) && whyNotCommand(session_).empty())
        button("Again", Action::kAgain, "The bone is put back, and the scripted hand begins anew");
    if (!why_not.empty()) sayWrapped(why_not, HudTone::kWarning);
    sayQuietly(is_holding ? withKey("Mouse and keys: the help", Action::kHelp)
                          : keyLabelOf(Action::kHoldTool) + " takes it where the mouse is");
}

void PanelContent::buildTransparency() {
    box("Transparent", Action::kTransparency, settings_.is_transparent,
        "Bone lets the tool and inner walls through");
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    if (const auto opacity =
            slider("##opacity", settings_.opacity, kMinOpacity, "How dense the transparent bone is"))
        controls_.setOpacity(*opacity);
    ImGui::PopItemWidth();
}

void PanelContent::buildSigns() {
    box("Force arrow", Action::kForceArrow, settings_.show_force,
        "The contact force on the hand, at the burr");
    ImGui::SameLine();
    box("Quick drawing", Action::kQuickDrawing, settings_.quality == Quality::kQuick,
        "Without shadows and smooth edges: for PCs without a graphics card");
    buildQualityPick();
    if (session_.info && session_.info->handpiece() != topics::SceneInfo::NO_HANDPIECE &&
        box("Handpiece", settings_.show_handpiece, "Behind the tool's shaft; it is only drawn"))
        controls_.showHandpiece(!settings_.show_handpiece);
    box("Figures", Action::kHud, settings_.show_hud, "What is written over the picture");
    ImGui::SameLine();
    box("All", Action::kDetails, settings_.show_hud && settings_.show_details,
        "Also how well the session runs");
    box("Watchers", Action::kWatchers, settings_.show_watchers, "Who is watching, over the picture");
    ImGui::SameLine();
    box("Help", Action::kHelp, settings_.show_help, "All keys, over the picture");
    buildReading();
}

void PanelContent::buildReading() {
    constexpr struct {
        const char* label;
        double factor;
    } kSizes[] = {{"Small", 0.8}, {"Normal", 1}, {"Large", 1.25}};
    ImGui::AlignTextToFramePadding();
    sayQuietly(withKey("Text", Action::kLargerText));
    for (const auto& size : kSizes) {
        ImGui::SameLine();
        if (choice(size.label, std::abs(settings_.text_scale - size.factor) < 1e-6, "Of figures and panel"))
            controls_.setTextScale(size.factor);
    }
    if (box("Colours for colour-blind people", settings_.is_for_colour_blind,
            "Zones, differences, structures and warnings can be told apart without red and green, or blue"))
        controls_.showForColourBlind(!settings_.is_for_colour_blind);
}

void PanelContent::buildQualityPick() {
    const bool is_quick = settings_.quality == Quality::kQuick;
    if (box("Quality by speed", settings_.picks_quality,
            "Full while pictures are fast enough, quick while they are not"))
        controls_.pickQuality(!settings_.picks_quality);
    if (!settings_.picks_quality) return;
    ImGui::SameLine();
    sayQuietly(std::string(is_quick ? "now quick" : "now full") +
               (session_.picture_s > 0 ? ", " + figureText(session_.picture_s * 1e3, 0, " ms") : ""));
}

bool PanelContent::hasPatientAxes() const {
    return !session_.info || !session_.info->lacks_patient_axes();
}

void PanelContent::buildSides() {
    constexpr struct {
        Side side;
        const char *label, *what;            // of the patient
        const char *axis_label, *axis_what;  // where it is not known how the patient lay
    } kSides[] = {{Side::kFront, "Front", "From the patient's front", "-y", "From where y is least"},
                  {Side::kBack, "Back", "From the patient's back", "+y", "From where y is most"},
                  {Side::kLeft, "Left", "From the patient's left", "+x", "From where x is most"},
                  {Side::kRight, "Right", "From the patient's right", "-x", "From where x is least"},
                  {Side::kTop, "Top", "From above the patient's head", "+z", "From where z is most"},
                  {Side::kBottom, "Below", "From the patient's feet", "-z", "From where z is least"}};
    const bool are_patients = hasPatientAxes();
    for (const auto& side : kSides) {
        if (side.side != Side::kFront) ImGui::SameLine();
        const bool is_pressed =
            are_patients ? button(side.label, side.what) : button(side.axis_label, side.axis_what);
        if (is_pressed) controls_.lookFrom(side.side);
    }
}

void PanelContent::buildCuts() {
    constexpr struct {
        const char* label;
        const char* flip;
        const char* position;
        const char *what, *axis_what;
    } kCuts[] = {{"Cut X", "Flip##x", "##cut x", "Sagittal plane: hides the bone on the patient's left",
                  "Plane across x: hides the bone where x is more"},
                 {"Cut Y", "Flip##y", "##cut y", "Coronal plane: hides the bone at the back",
                  "Plane across y: hides the bone where y is more"},
                 {"Cut Z", "Flip##z", "##cut z", "Axial plane: hides the bone above",
                  "Plane across z: hides the bone where z is more"}};
    for (size_t axis = 0; axis < std::size(kCuts); ++axis) {
        const auto& cut = kCuts[axis];
        const CutPlane& plane = settings_.cuts[axis];
        if (box(cut.label, plane.is_on, hasPatientAxes() ? cut.what : cut.axis_what))
            act(Action(int(Action::kCutX) + int(axis)));
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

void PanelContent::buildScan() {
    const CtShown ct = settings_.slices.ct;
    box("Slices", Action::kSlices, settings_.slices.are_shown,
        "Three slices through the scan at the burr, beside the picture");
    const bool is_grey = ct == CtShown::kOnCuts || ct == CtShown::kOnCutsAndMilled;
    if (box(withKey("Scan on cuts", Action::kScanOnBone), is_grey, "Cut faces show the scan's grey values"))
        controls_.showScan(is_grey ? CtShown::kNowhere : CtShown::kOnCuts);
    ImGui::SameLine();
    if (box("Milled", ct == CtShown::kOnCutsAndMilled, "Milled bone shows what the scan measured there"))
        controls_.showScan(ct == CtShown::kOnCutsAndMilled ? CtShown::kOnCuts : CtShown::kOnCutsAndMilled);
    const bool has_materials = ct == CtShown::kMaterialsOnCuts;
    if (box("Materials on cuts", has_materials, "Cut faces have the colours of the scene's materials"))
        controls_.showScan(has_materials ? CtShown::kOnCuts : CtShown::kMaterialsOnCuts);
}

void PanelContent::buildStereo() {
    const auto offer = [this](const char* label, StereoMode mode, const char* what) {
        if (choice(label, settings_.stereo == mode, what)) controls_.setStereo(mode);
    };
    sayQuietly(withKey("Stereo", Action::kStereo));
    offer("Off", StereoMode::kOff, "One picture");
    ImGui::SameLine();
    offer("Side by side", StereoMode::kSideBySide, "The left eye's picture beside the right eye's");
    ImGui::SameLine();
    offer("Red/cyan", StereoMode::kAnaglyph, "For glasses with a red and a cyan lens");
}

bool PanelContent::hasEffects() const {
    return std::ranges::any_of(kEffects, [this](const auto& e) { return isListed(e.effect); });
}

bool PanelContent::isListed(ViewerEffect effect) const {
    if (!session_.info) return false;
    const scene::Effects& listed = session_.info->viewer_effects();
    switch (effect) {
        case ViewerEffect::kBoneDust:
            return listed.has_bone_dust();
        case ViewerEffect::kBleeding:
            return listed.has_bleeding();
        case ViewerEffect::kIrrigation:
            return listed.has_irrigation();
        case ViewerEffect::kBurrSpin:
            return listed.has_burr_spin();
        case ViewerEffect::kMillingSound:
            return listed.has_milling_sound();
        case ViewerEffect::kBrowning:
            return listed.has_browning();
        case ViewerEffect::kBruising:
            return listed.has_bruising();
        case ViewerEffect::kPulse:
            return listed.has_pulse();
    }
    return false;
}

void PanelContent::buildEffects() {
    for (const auto& e : kEffects) {
        const bool is_shown = settings_.shows(e.effect);
        if (isListed(e.effect) && box(e.label, is_shown, e.what)) controls_.showEffect(e.effect, !is_shown);
    }
}

bool PanelContent::hasStructures() const {
    return session_.info &&
           std::ranges::any_of(session_.info->materials(), [](const auto& m) { return m.is_protected(); });
}

// The first place of the modes is free: there the key counts on.
void PanelContent::buildStructures() {
    for (int i = 0; i < session_.info->materials_size(); ++i) {
        if (!session_.info->materials(i).is_protected()) continue;
        const auto structure = size_t(i) + 1;
        const std::string name = structureName(uint32_t(structure), session_.info);
        const StructureMode mode = settings_.structures[structure];
        const Eigen::Vector3f colour = structureColour(*session_.info, uint32_t(structure));
        const bool is_on = mode != StructureMode::kOff, is_through = mode == StructureMode::kThroughBone;
        ImGui::PushID(int(structure));
        ImGui::ColorButton("##colour", ImVec4(colour.x(), colour.y(), colour.z(), 1),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker);
        ImGui::SameLine();
        if (box(name, is_on, "Is seen or not"))
            controls_.showStructure(structure, is_on ? StructureMode::kOff : StructureMode::kExposedOnly);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - 7.5f * ImGui::GetFontSize());
        ImGui::BeginDisabled(!is_on);
        if (box("through bone", is_through, "Is seen behind bone, too, and not only where it is exposed"))
            controls_.showStructure(structure,
                                    is_through ? StructureMode::kExposedOnly : StructureMode::kThroughBone);
        ImGui::EndDisabled();
        ImGui::PopID();
    }
    button("All", Action::kStructures,
           "All are seen where they are exposed, or through all bone, or not at all");
    ImGui::SameLine();
    box("Thickness", Action::kThickness, settings_.show_thickness,
        "Bone has the colour of its distance to the next structure");
    if (box("Distance line", settings_.show_clearance,
            "From the burr to the nearest structure, when that is near"))
        controls_.showClearance(!settings_.show_clearance);
}

}  // namespace bonemill
