// Here are the panel's parts about what is seen, view, structures and effects, and about the mouse that holds
// the tool.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render_client/language/language.h"
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
} kEffects[] = {
    {trMark("Bone dust"), ViewerEffect::kBoneDust, trMark("Grains that leave the burr")},
    {trMark("Bleeding"), ViewerEffect::kBleeding, trMark("Blood on fresh cuts")},
    {trMark("Irrigation"), ViewerEffect::kIrrigation, trMark("Water, while the pedal is down")},
    {trMark("Burr spin"), ViewerEffect::kBurrSpin, trMark("Flutes that turn")},
    {trMark("Milling sound"), ViewerEffect::kMillingSound, trMark("Motor and cutting, heard here")},
    {trMark("Browning"), ViewerEffect::kBrowning, trMark("Bone that got too hot")},
    {trMark("Bruising"), ViewerEffect::kBruising, trMark("Protected structures that were touched")},
    {trMark("Pulse"), ViewerEffect::kPulse, trMark("Open dura and vessels rise with the heart")}};

}  // namespace

void PanelContent::buildView() {
    sayQuietly(tr("Cut open"));
    buildCuts();
    gap();
    button(tr("First view"), Action::kFirstView, tr("Back to the view that the scene starts with"));
    buildSides();
    box(tr("Endoscope"), Action::kEndoscope, settings_.camera == CameraMode::kEndoscope,
        tr("Looks along the tool past its burr, instead of from around the bone"));
    ImGui::SameLine();
    box(tr("Microscope"), Action::kMicroscope, settings_.camera == CameraMode::kMicroscope,
        tr("A round field, lit along the line of sight; the wheel magnifies"));
    if (settings_.camera == CameraMode::kMicroscope && box(tr("Depth of field"), settings_.has_depth_of_field,
                                                           tr("Blurs what the microscope is not focused on")))
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
    box(tr("Hold the tool"), Action::kHoldTool, is_holding,
        tr("The tool follows the mouse; the left button mills"));
    ImGui::EndDisabled();
    if (isTakenOver(session_) && whyNotCommand(session_).empty())
        button(tr("Again"), Action::kAgain, tr("The bone is put back, and the scripted hand begins anew"));
    if (!why_not.empty()) sayWrapped(why_not, HudTone::kWarning);
    sayQuietly(is_holding ? withKey(tr("Mouse and keys: the help"), Action::kHelp)
                          : tr("{1} takes it where the mouse is", {keyLabelOf(Action::kHoldTool)}));
}

void PanelContent::buildTransparency() {
    box(tr("Transparent"), Action::kTransparency, settings_.is_transparent,
        tr("Bone lets the tool and inner walls through"));
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    if (const auto opacity =
            slider("##opacity", settings_.opacity, kMinOpacity, tr("How dense the transparent bone is")))
        controls_.setOpacity(*opacity);
    ImGui::PopItemWidth();
}

void PanelContent::buildSigns() {
    box(tr("Force arrow"), Action::kForceArrow, settings_.show_force,
        tr("The contact force on the hand, at the burr"));
    ImGui::SameLine();
    box(tr("Quick drawing"), Action::kQuickDrawing, settings_.quality == Quality::kQuick,
        tr("Without shadows and smooth edges: for PCs without a graphics card"));
    buildQualityPick();
    if (session_.info && session_.info->handpiece() != topics::SceneInfo::NO_HANDPIECE &&
        box(tr("Handpiece"), settings_.show_handpiece, tr("Behind the tool's shaft; it is only drawn")))
        controls_.showHandpiece(!settings_.show_handpiece);
    box(tr("Figures"), Action::kHud, settings_.show_hud, tr("What is written over the picture"));
    ImGui::SameLine();
    box(tr("All"), Action::kDetails, settings_.show_hud && settings_.show_details,
        tr("Also how well the session runs"));
    box(tr("Watchers"), Action::kWatchers, settings_.show_watchers, tr("Who is watching, over the picture"));
    ImGui::SameLine();
    box(tr("Help"), Action::kHelp, settings_.show_help, tr("All keys, over the picture"));
    buildReading();
}

void PanelContent::buildReading() {
    constexpr struct {
        const char* label;
        double factor;
    } kSizes[] = {{trMark("Small"), 0.8}, {trMark("Normal"), 1}, {trMark("Large"), 1.25}};
    ImGui::AlignTextToFramePadding();
    sayQuietly(withKey(tr("Text"), Action::kLargerText));
    for (const auto& size : kSizes) {
        ImGui::SameLine();
        if (choice(tr(size.label), std::abs(settings_.text_scale - size.factor) < 1e-6,
                   tr("Of figures and panel")))
            controls_.setTextScale(size.factor);
    }
    if (box(tr("Colours for colour-blind people"), settings_.is_for_colour_blind,
            tr("Zones, differences, structures and warnings can be told apart without red and green, or "
               "blue")))
        controls_.showForColourBlind(!settings_.is_for_colour_blind);
    buildLanguages();
}

// Whoever cannot read the language that is spoken finds the others by their own names.
void PanelContent::buildLanguages() {
    if (languages().size() < 2) return;
    sayQuietly("Language / Sprache / Spr\u00e5k");
    const float right = ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x;
    for (const Language& language : languages()) {
        const ImGuiStyle& style = ImGui::GetStyle();
        const float width = ImGui::GetFrameHeight() + style.ItemInnerSpacing.x +
                            ImGui::CalcTextSize(language.name.c_str()).x + style.ItemSpacing.x;
        const bool is_first = language.code == kEnglish;
        if (!is_first && ImGui::GetItemRectMax().x + width <= right) ImGui::SameLine();
        if (choice(language.name, language.code == spokenLanguage(),
                   tr("Of the windows; scenes, commands and the log stay as they are")))
            wishes_.language = language.code;
    }
}

void PanelContent::buildQualityPick() {
    const bool is_quick = settings_.quality == Quality::kQuick;
    if (box(tr("Quality by speed"), settings_.picks_quality,
            tr("Full while pictures are fast enough, quick while they are not")))
        controls_.pickQuality(!settings_.picks_quality);
    if (!settings_.picks_quality) return;
    ImGui::SameLine();
    sayQuietly(std::string(is_quick ? tr("now quick") : tr("now full")) +
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
    } kSides[] = {{Side::kFront, trMark("Front"), trMark("From the patient's front"), "-y",
                   trMark("From where y is least")},
                  {Side::kBack, trMark("Back"), trMark("From the patient's back"), "+y",
                   trMark("From where y is most")},
                  {Side::kLeft, trMark("Left"), trMark("From the patient's left"), "+x",
                   trMark("From where x is most")},
                  {Side::kRight, trMark("Right"), trMark("From the patient's right"), "-x",
                   trMark("From where x is least")},
                  {Side::kTop, trMark("Top"), trMark("From above the patient's head"), "+z",
                   trMark("From where z is most")},
                  {Side::kBottom, trMark("Below"), trMark("From the patient's feet"), "-z",
                   trMark("From where z is least")}};
    const bool are_patients = hasPatientAxes();
    for (const auto& side : kSides) {
        if (side.side != Side::kFront) ImGui::SameLine();
        const bool is_pressed = are_patients ? button(tr(side.label), tr(side.what))
                                             : button(side.axis_label, tr(side.axis_what));
        if (is_pressed) controls_.lookFrom(side.side);
    }
}

void PanelContent::buildCuts() {
    constexpr struct {
        const char* label;
        const char* position;
        const char *what, *axis_what;
    } kCuts[] = {{trMark("Cut X"), "##cut x", trMark("Sagittal plane: hides the bone on the patient's left"),
                  trMark("Plane across x: hides the bone where x is more")},
                 {trMark("Cut Y"), "##cut y", trMark("Coronal plane: hides the bone at the back"),
                  trMark("Plane across y: hides the bone where y is more")},
                 {trMark("Cut Z"), "##cut z", trMark("Axial plane: hides the bone above"),
                  trMark("Plane across z: hides the bone where z is more")}};
    constexpr const char* kFlips[] = {"##x", "##y", "##z"};
    for (size_t axis = 0; axis < std::size(kCuts); ++axis) {
        const auto& cut = kCuts[axis];
        const CutPlane& plane = settings_.cuts[axis];
        if (box(tr(cut.label), plane.is_on, tr(hasPatientAxes() ? cut.what : cut.axis_what)))
            act(Action(int(Action::kCutX) + int(axis)));
        ImGui::SameLine();
        if (box(tr("Flip") + std::string(kFlips[axis]), plane.is_flipped, tr("Hides the other side")))
            act(Action(int(Action::kFlipX) + int(axis)));
        ImGui::SameLine();
        ImGui::PushItemWidth(-1);
        if (const auto position =
                slider(cut.position, plane.position, 0, tr("Where the plane is, across the bone")))
            controls_.moveCutTo(axis, *position);
        ImGui::PopItemWidth();
    }
}

void PanelContent::buildScan() {
    const CtShown ct = settings_.slices.ct;
    box(tr("Slices"), Action::kSlices, settings_.slices.are_shown,
        tr("Three slices through the scan at the burr, beside the picture"));
    const bool is_grey = ct == CtShown::kOnCuts || ct == CtShown::kOnCutsAndMilled;
    if (box(withKey(tr("Scan on cuts"), Action::kScanOnBone), is_grey,
            tr("Cut faces show the scan's grey values")))
        controls_.showScan(is_grey ? CtShown::kNowhere : CtShown::kOnCuts);
    ImGui::SameLine();
    if (box(tr("Milled"), ct == CtShown::kOnCutsAndMilled,
            tr("Milled bone shows what the scan measured there")))
        controls_.showScan(ct == CtShown::kOnCutsAndMilled ? CtShown::kOnCuts : CtShown::kOnCutsAndMilled);
    const bool has_materials = ct == CtShown::kMaterialsOnCuts;
    if (box(tr("Materials on cuts"), has_materials,
            tr("Cut faces have the colours of the scene's materials")))
        controls_.showScan(has_materials ? CtShown::kOnCuts : CtShown::kMaterialsOnCuts);
}

void PanelContent::buildStereo() {
    const auto offer = [this](const char* label, StereoMode mode, const char* what) {
        if (choice(label, settings_.stereo == mode, what)) controls_.setStereo(mode);
    };
    sayQuietly(withKey(tr("Stereo"), Action::kStereo));
    offer(tr("Off"), StereoMode::kOff, tr("One picture"));
    ImGui::SameLine();
    offer(tr("Side by side"), StereoMode::kSideBySide, tr("The left eye's picture beside the right eye's"));
    ImGui::SameLine();
    offer(tr("Red/cyan"), StereoMode::kAnaglyph, tr("For glasses with a red and a cyan lens"));
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
        if (isListed(e.effect) && box(tr(e.label), is_shown, tr(e.what)))
            controls_.showEffect(e.effect, !is_shown);
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
        if (box(name, is_on, tr("Is seen or not")))
            controls_.showStructure(structure, is_on ? StructureMode::kOff : StructureMode::kExposedOnly);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - 7.5f * ImGui::GetFontSize());
        ImGui::BeginDisabled(!is_on);
        if (box(tr("through bone"), is_through,
                tr("Is seen behind bone, too, and not only where it is exposed")))
            controls_.showStructure(structure,
                                    is_through ? StructureMode::kExposedOnly : StructureMode::kThroughBone);
        ImGui::EndDisabled();
        ImGui::PopID();
    }
    button(tr("All"), Action::kStructures,
           tr("All are seen where they are exposed, or through all bone, or not at all"));
    ImGui::SameLine();
    box(tr("Thickness"), Action::kThickness, settings_.show_thickness,
        tr("Bone has the colour of its distance to the next structure"));
    if (box(tr("Distance line"), settings_.show_clearance,
            tr("From the burr to the nearest structure, when that is near")))
        controls_.showClearance(!settings_.show_clearance);
}

}  // namespace bonemill
