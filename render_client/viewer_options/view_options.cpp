#include "render_client/viewer_options/view_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "common/cli/command_line.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr double kNarrowestWindow = 1;

void addCutOptions(CLI::App& app, RawView& raw, std::vector<CLI::Option*>& view_options) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    constexpr const char* kHidden[] = {"the patient's left", "the back", "the upper part"};
    for (size_t axis = 0; axis < 3; ++axis) {
        const std::string cut_name = std::string("--cut-") + kAxes[axis];
        auto* cut = app.add_option(cut_name, raw.cuts[axis],
                                   std::string("Cut-plane that hides ") + kHidden[axis] +
                                       ", from the low (0) to the high end (1) of the bone")
                        ->check(within(0, 1))
                        ->type_name("POSITION");
        auto* flip = app.add_flag(std::string("--flip-") + kAxes[axis], raw.flips[axis],
                                  "Hides the other side of " + cut_name)
                         ->needs(cut);
        view_options.insert(view_options.end(), {cut, flip});
    }
}

std::string opacityText() {
    char text[16];
    std::snprintf(text, sizeof text, "%g", ViewSettings::kDefaultOpacity);
    return text;
}

std::vector<std::string> languageCodes() {
    std::vector<std::string> codes;
    for (const Language& language : languages()) codes.push_back(language.code);
    return codes;
}

}  // namespace

std::vector<CLI::Option*> addViewOptions(CLI::App& app, RawView& raw) {
    std::vector<CLI::Option*> view_options;
    addCutOptions(app, raw, view_options);
    auto* transparent = app.add_option_function<std::string>(
                               "--transparent",
                               [&raw](const std::string& opacity) {  // empty: none was given
                                   raw.is_transparent = true;
                                   if (!opacity.empty()) raw.opacity = std::stod(opacity);
                               },
                               "Transparent bone, of this opacity, 0 to 1 (default " + opacityText() + ")")
                            ->expected(0, 1)
                            ->check(within(0, 1))
                            ->type_name("[OPACITY]");
    auto* structures =
        app.add_option(
               "--structures", raw.structures,
               "Protected structures are seen where exposed and through thin bone, through-bone, or off")
            ->check(CLI::IsMember({"exposed", "through-bone", "off"}))
            ->capture_default_str();
    auto* thickness = app.add_flag("--thickness", raw.thickness,
                                   "Bone has the colour of its distance to the next protected structure");
    auto* stereo = app.add_option("--stereo", raw.stereo, "off, side-by-side or anaglyph (red-cyan glasses)")
                       ->check(CLI::IsMember({"off", "side-by-side", "anaglyph"}))
                       ->capture_default_str();
    auto* camera = app.add_option("--camera", raw.camera,
                                  "orbit; endoscope: rides on the tool; microscope: round field (default as "
                                  "remembered, else orbit)")
                       ->check(CLI::IsMember({"orbit", "endoscope", "microscope"}));
    auto* blur = app.add_flag("--depth-of-field", raw.has_depth_of_field,
                              "The microscope blurs what it is not focused on");
    auto* quality =
        app.add_option("--quality", raw.quality,
                       "full; quick: without shadow and antialiasing; auto: in a window by the time that "
                       "pictures take (default as remembered, else auto)")
            ->check(CLI::IsMember({"auto", "full", "quick"}));
    auto* no_handpiece = app.add_flag("--no-handpiece", raw.no_handpiece, "The tool without its handpiece");
    auto* no_hud = app.add_flag("--no-hud", raw.no_hud, "Nothing but the picture: no panel, list or scale");
    auto* text =
        app.add_option("--text-scale", raw.text_scale, "Text so much larger than what suits the picture")
            ->check(within(ViewSettings::kMinText, ViewSettings::kMaxText))
            ->type_name("FACTOR");
    auto* language = app.add_option("--language", raw.language,
                                    "Of figures and panel (default in a window as chosen there, else the "
                                    "desktop's; off screen en)")
                         ->check(CLI::IsMember(languageCodes()))
                         ->type_name("CODE");
    auto* slices = app.add_flag("--slices", raw.slices, "Three slices through the scan beside the picture");
    auto* scan = app.add_option("--scan-on", raw.scan_on,
                                "Where bone shows the scan's grey values: off, cuts, milled (and cuts); "
                                "materials: cuts have the colours of the scene's materials")
                     ->check(CLI::IsMember({"off", "cuts", "milled", "materials"}))
                     ->capture_default_str();
    auto* window = app.add_option("--grey-window", raw.grey_window,
                                  "Width and level of the grey values, as the scan has them (HU)")
                       ->expected(2)
                       ->check(within(-1e6, 1e6))
                       ->type_name("WIDTH LEVEL");
    view_options.insert(view_options.end(), {language, slices, scan, window, structures, thickness});
    view_options.insert(view_options.end(),
                        {transparent, stereo, camera, blur, quality, no_handpiece, no_hud, text});
    return view_options;
}

ViewSettings viewSettings(const RawView& raw) {
    ViewSettings settings;
    for (size_t axis = 0; axis < 3; ++axis)
        if (raw.cuts[axis]) settings.cuts[axis] = {true, *raw.cuts[axis], raw.flips[axis]};
    settings.is_transparent = raw.is_transparent;
    settings.opacity = raw.opacity.value_or(ViewSettings::kDefaultOpacity);
    settings.structures.fill(raw.structures == "off"            ? StructureMode::kOff
                             : raw.structures == "through-bone" ? StructureMode::kThroughBone
                                                                : StructureMode::kExposedOnly);
    settings.show_thickness = raw.thickness;
    settings.stereo = raw.stereo == "side-by-side" ? StereoMode::kSideBySide
                      : raw.stereo == "anaglyph"   ? StereoMode::kAnaglyph
                                                   : StereoMode::kOff;
    settings.camera = raw.camera == "endoscope"    ? CameraMode::kEndoscope
                      : raw.camera == "microscope" ? CameraMode::kMicroscope
                                                   : CameraMode::kOrbit;
    settings.has_depth_of_field = raw.has_depth_of_field;
    settings.quality = raw.quality == "quick" ? Quality::kQuick : Quality::kFull;
    settings.slices.are_shown = raw.slices;
    settings.slices.ct = raw.scan_on == "off"         ? CtShown::kNowhere
                         : raw.scan_on == "milled"    ? CtShown::kOnCutsAndMilled
                         : raw.scan_on == "materials" ? CtShown::kMaterialsOnCuts
                                                      : CtShown::kOnCuts;
    if (raw.grey_window.size() == 2)
        settings.slices.window =
            GreyWindow{std::max(raw.grey_window[0], kNarrowestWindow), raw.grey_window[1]};
    settings.show_handpiece = !raw.no_handpiece;
    settings.show_hud = !raw.no_hud;
    settings.text_scale = raw.text_scale.value_or(1);
    return settings;
}

}  // namespace bonemill
