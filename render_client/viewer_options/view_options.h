// These options say what is shown at the start.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render_client/look/camera/view_settings.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bonemill {

struct RawView {
    std::array<std::optional<double>, 3> cuts;
    std::array<bool, 3> flips{};
    std::optional<double> opacity;
    bool is_transparent = false;
    std::string stereo = "off";
    std::optional<std::string> camera;  // none was said: orbit
    bool has_depth_of_field = false;
    std::optional<std::string> quality;  // none was said: auto
    std::string structures = "exposed";
    bool thickness = false;
    std::optional<double> text_scale;
    std::string language;  // empty: none was said
    bool no_handpiece = false;
    bool no_hud = false;
    bool slices = false;
    std::string scan_on = "cuts";
    std::vector<double> grey_window;  // width, level
};

// Returns the options, for those that exclude them. `raw` must outlive the parsing.
std::vector<CLI::Option*> addViewOptions(CLI::App& app, RawView& raw);
ViewSettings viewSettings(const RawView& raw);

}  // namespace bonemill
