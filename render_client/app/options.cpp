#include "render_client/app/options.h"

#include <pwd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iostream>

#include "common/config/user_error.h"
#include "common/dds/network_cli.h"

namespace bonemill {
namespace {

constexpr double kMmToMetres = 1e-3;
constexpr double kDegreesToRadians = M_PI / 180;
constexpr int kMinSize = 64;
constexpr uint32_t kDefaultTimeoutS = 60;
constexpr int kMaxSize = 8192;  // pixels; every OpenGL 3.3 driver in use can do it

// What the command line holds before units are converted.
struct RawOptions {
    bool offscreen = false;
    OffscreenOptions offscreen_options;
    uint32_t interval_ms = 500;
    std::optional<uint32_t> timeout_s;
    std::string role;
    std::string size;
    std::string set_accuracy;
    std::optional<double> azimuth_deg, elevation_deg, distance_mm;
    std::vector<double> target_mm;
    std::array<std::optional<double>, 3> cuts;
    std::array<bool, 3> flips{};
    std::optional<double> opacity;
    bool is_transparent = false;
    std::string stereo = "off";
    std::string camera = "orbit";
    bool no_hud = false;
};

std::string loginName() {
    const passwd* user = getpwuid(getuid());
    return user ? user->pw_name : "";
}

void parseSize(const std::string& text, ClientOptions& options) {
    int width = 0, height = 0, used = 0;
    const int fields = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used);
    const auto in_range = [](int size) { return size >= kMinSize && size <= kMaxSize; };
    if (fields != 2 || size_t(used) != text.size() || !in_range(width) || !in_range(height)) {
        throw UserError("--size " + text + ": expected WxH, each " + std::to_string(kMinSize) + " to " +
                        std::to_string(kMaxSize) + " pixels, such as 1280x800");
    }
    options.width = width;
    options.height = height;
}

// The server knows which names there are; here only what cannot be one is refused.
std::string accuracyNameProblem(const std::string& name) {
    const auto is_sign = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    if (!name.empty() && std::all_of(name.begin(), name.end(), is_sign)) return "";
    return "'" + name + "' is no name of a preset, such as balanced, nor scene";
}

void addCutOptions(CLI::App& app, RawOptions& raw, std::vector<CLI::Option*>& view_options) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    constexpr const char* kHidden[] = {"the patient's left", "the back", "the upper part"};
    for (size_t axis = 0; axis < 3; ++axis) {
        const std::string cut_name = std::string("--cut-") + kAxes[axis];
        auto* cut = app.add_option(cut_name, raw.cuts[axis],
                                   std::string("Cut-plane that hides ") + kHidden[axis] +
                                       ", from the low (0) to the high end (1) of the bone")
                        ->check(CLI::Range(0.0, 1.0))
                        ->type_name("POSITION");
        auto* flip = app.add_flag(std::string("--flip-") + kAxes[axis], raw.flips[axis],
                                  "Hides the other side of " + cut_name)
                         ->needs(cut);
        view_options.insert(view_options.end(), {cut, flip});
    }
}

// What the window's keys switch, at the start.
std::vector<CLI::Option*> addViewOptions(CLI::App& app, RawOptions& raw) {
    std::vector<CLI::Option*> view_options;
    addCutOptions(app, raw, view_options);
    auto* transparent = app.add_option_function<std::string>(
                               "--transparent",
                               [&raw](const std::string& opacity) {  // empty: none was given
                                   raw.is_transparent = true;
                                   if (!opacity.empty()) raw.opacity = std::stod(opacity);
                               },
                               "Transparent bone, of this opacity, 0 to 1 (default 0.35)")
                            ->expected(0, 1)
                            ->check(CLI::Range(0.0, 1.0))
                            ->type_name("[OPACITY]");
    auto* stereo = app.add_option("--stereo", raw.stereo, "off, side-by-side or anaglyph (red-cyan glasses)")
                       ->check(CLI::IsMember({"off", "side-by-side", "anaglyph"}))
                       ->capture_default_str();
    auto* camera = app.add_option("--camera", raw.camera, "orbit, or endoscope: rides on the tool")
                       ->check(CLI::IsMember({"orbit", "endoscope"}))
                       ->capture_default_str();
    auto* no_hud = app.add_flag("--no-hud", raw.no_hud, "Nothing but the picture: no panel, list or scale");
    view_options.insert(view_options.end(), {transparent, stereo, camera, no_hud});
    return view_options;
}

void addOptions(CLI::App& app, RawOptions& raw, ClientOptions& options) {
    const std::vector<CLI::Option*> view_options = addViewOptions(app, raw);
    app.add_option("--domain", options.subscriber.domain, "DDS domain of the server")
        ->check(CLI::Range(uint32_t{0}, dds::kMaxDomain))
        ->capture_default_str();
    app.add_option("--session", options.subscriber.session, "Number that haptic_server was started with")
        ->capture_default_str();
    dds::addNetworkOptions(app, options.network);
    app.add_option("--name", options.subscriber.name, "What the others read in their list of viewers")
        ->capture_default_str();
    app.add_option(
           "--role", raw.role,
           "viewer: only looks; operator: also commands; instructor: also points and ends the session "
           "(default operator, with --profile lab or classroom viewer)")
        ->check(CLI::IsMember({"viewer", "operator", "instructor"}));
    app.add_option("--size", raw.size, "Picture or window, pixels (default 1280x800)")->type_name("WxH");
    app.add_option("--camera-azimuth-deg", raw.azimuth_deg, "Eye: 0 in front of the patient, 90 at the left")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--camera-elevation-deg", raw.elevation_deg, "Eye above the horizon")
        ->check(CLI::Range(-89.0, 89.0));
    app.add_option("--camera-distance-mm", raw.distance_mm, "Eye to target")
        ->check(CLI::Range(OrbitCamera::kMinDistance / kMmToMetres, OrbitCamera::kMaxDistance / kMmToMetres));
    app.add_option("--camera-target-mm", raw.target_mm, "Point to look at, world frame")
        ->expected(3)
        ->check(CLI::Range(-1e6, 1e6))
        ->type_name("X Y Z");
    app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
        ->capture_default_str();

    auto* offscreen =
        app.add_flag("--offscreen", raw.offscreen, "Write PNG pictures instead of opening a window");
    app.add_option("--frames", raw.offscreen_options.frames, "How many pictures")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str()
        ->needs(offscreen);
    auto* out = app.add_option("--out", raw.offscreen_options.directory,
                               "Folder for frame_0000.png, frame_0001.png, ...");
    out->needs(offscreen);
    offscreen->needs(out);
    app.add_option("--interval-ms", raw.interval_ms, "Time between pictures")
        ->check(CLI::Range(0u, 3600000u))
        ->capture_default_str()
        ->needs(offscreen);
    app.add_flag("--wait-complete", raw.offscreen_options.wait_complete,
                 "Take the first picture when the whole model has arrived")
        ->needs(offscreen);
    auto* set_accuracy = app.add_option("--set-accuracy", raw.set_accuracy,
                                        "No viewer: ask the server for thesis_2012, fast, balanced, exact or "
                                        "scene (what the scene file "
                                        "says), print what it answers and stop")
                             ->check(accuracyNameProblem)
                             ->type_name("NAME")
                             ->excludes(offscreen);
    for (CLI::Option* option : view_options) set_accuracy->excludes(option);
    app.add_option("--timeout-s", raw.timeout_s,
                   "Give up --wait-complete, or --set-accuracy without a server, after this (default 60)")
        ->check(CLI::Range(1u, 86400u));
}

// Among several PCs whoever commands says so.
topics::Viewer::Role roleOf(const RawOptions& raw, const dds::NetworkOptions& network) {
    if (raw.role == "viewer") return topics::Viewer::VIEWER;
    if (raw.role == "instructor") return topics::Viewer::INSTRUCTOR;
    const bool only_looks =
        raw.role.empty() && raw.set_accuracy.empty() && dds::isLanProfile(network.profile);
    return only_looks ? topics::Viewer::VIEWER : topics::Viewer::OPERATOR;
}

ViewSettings viewSettings(const RawOptions& raw) {
    ViewSettings settings;
    for (size_t axis = 0; axis < 3; ++axis)
        if (raw.cuts[axis]) settings.cuts[axis] = {true, *raw.cuts[axis], raw.flips[axis]};
    settings.is_transparent = raw.is_transparent;
    settings.opacity = raw.opacity.value_or(ViewSettings::kDefaultOpacity);
    settings.stereo = raw.stereo == "side-by-side" ? StereoMode::kSideBySide
                      : raw.stereo == "anaglyph"   ? StereoMode::kAnaglyph
                                                   : StereoMode::kOff;
    settings.camera = raw.camera == "endoscope" ? CameraMode::kEndoscope : CameraMode::kOrbit;
    settings.show_hud = !raw.no_hud;
    return settings;
}

ClientOptions convert(const RawOptions& raw, ClientOptions options) {
    options.settings = viewSettings(raw);
    options.subscriber.role = roleOf(raw, options.network);
    if (!raw.size.empty()) parseSize(raw.size, options);
    if (raw.azimuth_deg) options.view.azimuth = *raw.azimuth_deg * kDegreesToRadians;
    if (raw.elevation_deg) options.view.elevation = *raw.elevation_deg * kDegreesToRadians;
    if (raw.distance_mm) options.view.distance = *raw.distance_mm * kMmToMetres;
    if (!raw.target_mm.empty()) {
        options.view.target =
            kMmToMetres * Eigen::Vector3d(raw.target_mm[0], raw.target_mm[1], raw.target_mm[2]);
    }
    if (raw.timeout_s && !raw.offscreen && raw.set_accuracy.empty())
        throw UserError("--timeout-s needs --offscreen or --set-accuracy");
    const std::chrono::seconds timeout(raw.timeout_s.value_or(kDefaultTimeoutS));
    if (raw.offscreen) {
        options.offscreen = raw.offscreen_options;
        options.offscreen->interval = std::chrono::milliseconds(raw.interval_ms);
        options.offscreen->timeout = timeout;
    }
    if (!raw.set_accuracy.empty()) options.set_accuracy = SetAccuracyOptions{raw.set_accuracy, timeout};
    return options;
}

}  // namespace

std::string serverQuestion(const SubscriberOptions& subscriber) {
    return "is a haptic_server running in domain " + std::to_string(subscriber.domain) + ", session " +
           std::to_string(subscriber.session) + "?";
}

std::optional<ClientOptions> parseOptions(int argc, const char* const* argv) {
    ClientOptions options;
    options.subscriber.name = loginName();
    RawOptions raw;
    CLI::App app{
        "Shows the session of a haptic_server in a window, or off screen as pictures (docs/viewer.md)."};
    addOptions(app, raw, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::cout << app.help();
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw UserError(std::string(error.what()) + " (see render_client --help)");
    }
    return convert(raw, options);
}

}  // namespace bonemill
