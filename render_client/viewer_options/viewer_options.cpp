#include "render_client/viewer_options/viewer_options.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/commands/role_rules.h"
#include "common/dds/network_cli.h"
#include "render_client/link/subscribe/command_words.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/viewer_options/view_options.h"
#include "render_client/viewer_options/web_options.h"

namespace bonemill {
namespace {

constexpr int kMinSize = 64;
constexpr int kMaxSize = 8192;  // pixels; every OpenGL 3.3 driver in use can do it

// Here is what the command line holds before units are converted.
struct RawOptions {
    CLI::Option* session = nullptr;
    CLI::Option* name = nullptr;
    bool offscreen = false;
    OffscreenOptions offscreen_options;
    VideoOptions video;
    uint32_t interval_ms = uint32_t(OffscreenOptions().interval.count());
    std::optional<uint32_t> timeout_s;
    std::optional<uint32_t> measure_s;
    bool measures_in_window = false;
    std::optional<std::string> role;
    std::string size;
    std::string command;
    std::optional<double> azimuth_deg, elevation_deg, distance_mm;
    std::vector<double> target_mm;
    RawView view;
    RawServe serve;
    RawRelay relay;
    RawConnect connect;
};

std::vector<std::string> roleNames() {
    std::vector<std::string> names;
    for (const topics::Viewer::Role role : kRoles) names.push_back(roleName(role));
    return names;
}

// The name is one of roleNames().
topics::Viewer::Role roleOf(const std::string& name) {
    return *std::ranges::find(kRoles, name, roleName);
}

std::string loginName() {
    const passwd* user = getpwuid(getuid());
    return user ? user->pw_name : "";
}

std::string sizeText(const ClientOptions& options) {
    return std::to_string(options.width) + "x" + std::to_string(options.height);
}

void parseSize(const std::string& text, ClientOptions& options) {
    int width = 0, height = 0, used = 0;
    const int fields = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used);
    const auto in_range = [](int size) { return size >= kMinSize && size <= kMaxSize; };
    if (fields != 2 || size_t(used) != text.size() || !in_range(width) || !in_range(height)) {
        throw UserError("--size " + text + ": expected WxH, each " + std::to_string(kMinSize) + " to " +
                        std::to_string(kMaxSize) + " pixels, such as " + sizeText(options));
    }
    options.width = width;
    options.height = height;
}

// Returns the options of DDS.
std::vector<CLI::Option*> addSessionOptions(CLI::App& app, RawOptions& raw, ClientOptions& options) {
    CLI::Option* const domain =
        app.add_option("--domain", options.subscriber.domain, "DDS domain of the server")
            ->check(CLI::Range(uint32_t{0}, dds::kMaxDomain))
            ->capture_default_str();
    raw.session = app.add_option("--session", options.subscriber.session,
                                 "Number that haptic_server was started with (default 1; a window takes the "
                                 "only session there is, or lets choose)");
    CLI::Option* const list =
        app.add_flag("--list", options.lists_sessions, "Print the sessions that are there, and end")
            ->excludes(raw.session);
    dds::addNetworkOptions(app, options.network);
    raw.name =
        app.add_option("--name", options.subscriber.name, "What the others read in their list of viewers")
            ->capture_default_str();
    app.add_flag(
        "--trainee", options.subscriber.is_trainee,
        "The trainee looks through this window: the recording takes what it sees (else, what the only "
        "operator sees)");
    CLI::Option* const role =
        app.add_option(
               "--role", raw.role,
               "viewer: only looks; operator: also commands; instructor: also points and ends the session; "
               "examiner: commands lesson and files (default operator; viewer under the profiles lab and "
               "classroom; with --secure what the identity says)")
            ->check(CLI::IsMember(roleNames()));
    addLogLevelOption(app, options.log_level);
    return {raw.session, domain, list, role};
}

void addPictureOptions(CLI::App& app, RawOptions& raw, ClientOptions& options) {
    app.add_option("--size", raw.size, "Picture or window, pixels (default " + sizeText(options) + ")")
        ->type_name("WxH");
    app.add_flag_callback(
        "--no-effects", [&options] { options.has_effects = false; },
        "None of the effects that the scene lists, neither seen nor heard");
    app.add_flag("--hold-tool", options.holds_tool,
                 "The mouse holds the tool at once, for a device_daemon with --device pointer");
    app.add_option("--sound-wav", options.sound_wav, "Write the scene's milling sound into this WAV file too")
        ->type_name("FILE");
    app.add_option(
           "--class-folder", options.class_folder,
           "Folder of this PC with the class' table and reports (--export-dir of its server): the window "
           "opens them")
        ->type_name("DIR");
    CLI::Option* const launcher =
        app.add_option("--launcher", options.launcher,
                       "bonemill's own script: with it the window opens replays and makes invitations")
            ->type_name("FILE");
    app.add_option("--recording", options.recording,
                   "The recording that is replayed here (.mcap): the window makes clips of it")
        ->type_name("FILE")
        ->needs(launcher);
}

void addCameraOptions(CLI::App& app, RawOptions& raw) {
    app.add_option("--camera-azimuth-deg", raw.azimuth_deg, "Eye: 0 in front of the patient, 90 at the left")
        ->check(within(-360, 360));
    app.add_option("--camera-elevation-deg", raw.elevation_deg, "Eye above the horizon")
        ->check(within(-89, 89));
    app.add_option("--camera-distance-mm", raw.distance_mm, "Eye to target")
        ->check(within(OrbitCamera::kMinDistance / kMillimetre, OrbitCamera::kMaxDistance / kMillimetre));
    app.add_option("--camera-target-mm", raw.target_mm, "Point to look at, world frame")
        ->expected(3)
        ->check(within(-1e6, 1e6))
        ->type_name("X Y Z");
}

void addVideoOptions(CLI::App& app, VideoOptions& video, CLI::Option* offscreen) {
    constexpr double kMinFrames = 1, kMaxFrames = 120;  // per second
    auto* file = app.add_option("--video", video.path, "Write a video (.mp4) instead of PNG pictures")
                     ->type_name("FILE")
                     ->needs(offscreen);
    app.add_option("--fps", video.fps, "Frames per second of the video")
        ->check(within(kMinFrames, kMaxFrames))
        ->capture_default_str()
        ->needs(file);
    app.add_option("--seconds", video.seconds, "The video is so long at most; 0: until the session ends")
        ->check(within(0, kMaxSeconds))
        ->capture_default_str()
        ->needs(file);
    app.add_option("--lead-replay", video.led_from_s,
                   "Leads a replay that waits from this moment (s) on, from picture to picture: none is "
                   "missing, however slow the PC")
        ->check(within(0, kMaxSeconds))
        ->type_name("SECONDS")
        ->needs(file);
}

// Returns the option that switches the window off, for those that exclude it.
CLI::Option* addOffscreenOptions(CLI::App& app, RawOptions& raw) {
    auto* offscreen = app.add_flag("--offscreen", raw.offscreen,
                                   "Write PNG pictures, or a video, instead of opening a window");
    auto* out = app.add_option("--out", raw.offscreen_options.directory,
                               "Folder for frame_0000.png, frame_0001.png, ...")
                    ->needs(offscreen);
    app.add_option("--frames", raw.offscreen_options.frames, "How many pictures")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str()
        ->needs(out);
    app.add_option("--interval-ms", raw.interval_ms, "Time between pictures")
        ->check(CLI::Range(0u, 3600000u))
        ->capture_default_str()
        ->needs(out);
    app.add_flag("--wait-complete", raw.offscreen_options.wait_complete,
                 "Take the first picture when the whole model has arrived")
        ->needs(offscreen);
    addVideoOptions(app, raw.video, offscreen);
    return offscreen;
}

// Throws UserError.
void convertOffscreen(const RawOptions& raw, std::chrono::seconds timeout, ClientOptions& options) {
    const bool has_video = !raw.video.path.empty();
    if (has_video == !raw.offscreen_options.directory.empty())
        throw UserError("--offscreen needs either --out FOLDER, for pictures, or --video FILE.mp4");
    if (has_video && !options.sound_wav.empty())
        throw UserError("--sound-wav goes with --out, not with --video");
    options.offscreen = raw.offscreen_options;
    options.offscreen->interval = std::chrono::milliseconds(raw.interval_ms);
    options.offscreen->timeout = timeout;
    if (has_video) options.offscreen->video = raw.video;
}

// Returns "\"reset\", \"shutdown\", ..." and so on.
std::string quotedCommands() {
    std::string text;
    for (const std::string& words : commandWords()) text += (text.empty() ? "\"" : ", \"") + words + "\"";
    return text;
}

// Returns the options that say what to do instead of a window.
std::vector<CLI::Option*> addCommandOptions(CLI::App& app, RawOptions& raw, CLI::Option* offscreen,
                                            const std::vector<CLI::Option*>& view_options) {
    auto* command = app.add_option("--command", raw.command,
                                   "No viewer: ask the server for " + quotedCommands() +
                                       "; print what it answers and stop")
                        ->check(commandProblem)
                        ->type_name("TEXT")
                        ->excludes(offscreen);
    for (CLI::Option* option : view_options) command->excludes(option);
    CLI::Option* measure =
        app.add_option(
               "--measure-s", raw.measure_s,
               "No viewer: draw off screen as fast as possible for so long, print what it costs and stop")
            ->check(CLI::Range(1u, 3600u))
            ->excludes(offscreen)
            ->excludes(command);
    app.add_flag("--in-window", raw.measures_in_window,
                 "With --measure-s: draw in a window, by the graphics card if there is one")
        ->needs(measure);
    app.add_option("--timeout-s", raw.timeout_s,
                   "Give up --wait-complete, or --command and --measure-s without a server, after this "
                   "(default " +
                       std::to_string(kDefaultTimeout.count()) + ")")
        ->check(CLI::Range(1u, 86400u));
    return {offscreen, command, measure};
}

void addOptions(CLI::App& app, RawOptions& raw, ClientOptions& options) {
    const std::vector<CLI::Option*> view_options = addViewOptions(app, raw.view);
    std::vector<CLI::Option*> of_dds = addSessionOptions(app, raw, options);
    addPictureOptions(app, raw, options);
    addCameraOptions(app, raw);
    std::vector<CLI::Option*> no_window =
        addCommandOptions(app, raw, addOffscreenOptions(app, raw), view_options);
    no_window.insert(no_window.end(), view_options.begin(), view_options.end());
    CLI::Option* const serve = addServeOptions(app, raw.serve, no_window);
    of_dds.push_back(serve);
    no_window.insert(no_window.end(), of_dds.begin(), of_dds.end());
    of_dds.push_back(addRelayOptions(app, raw.relay, serve, no_window));
    addConnectOptions(app, raw.connect, of_dds);
}

// With --secure the server asks the certificate who this is; what the viewer says of itself is the same.
void takeOver(const Identity& identity, const RawOptions& raw, ClientOptions& options) {
    if (raw.name->count() == 0) options.subscriber.name = identity.name;
    if (raw.session->count() == 0 && identity.session) options.subscriber.session = *identity.session;
    if (identity.role == "gateway") return;
    const std::string certified = identity.role == "observer" ? "viewer" : identity.role;
    const std::vector<std::string> names = roleNames();
    if (std::ranges::find(names, certified) == names.end()) return;  // not a viewer's folder: setNetwork()
    if (raw.role && *raw.role != certified)
        throw UserError("--role " + *raw.role + ": the identity of --secure is " + identity.name + "'s, " +
                        identity.role + "; leave --role out");
    options.subscriber.role = roleOf(certified);
}

ClientOptions convert(const RawOptions& raw, ClientOptions options) {
    options.settings = viewSettings(raw.view);
    options.language = raw.view.language;
    options.chooses_quality = raw.view.quality.value_or("auto") == "auto";
    options.said = {.size = !raw.size.empty(),
                    .quality = raw.view.quality.has_value(),
                    .camera = raw.view.camera.has_value(),
                    .text_scale = raw.view.text_scale.has_value()};
    const bool only_looks = dds::isLanProfile(options.network.profile);
    options.subscriber.role = raw.role     ? roleOf(*raw.role)
                              : only_looks ? topics::Viewer::VIEWER
                                           : topics::Viewer::OPERATOR;
    if (const auto identity = dds::identityOf(options.network)) takeOver(*identity, raw, options);
    options.chooses_session = raw.session->count() == 0 && !raw.connect.link && !raw.offscreen &&
                              !raw.measure_s && raw.command.empty();
    if (!raw.size.empty()) parseSize(raw.size, options);
    if (raw.azimuth_deg) options.view.azimuth = *raw.azimuth_deg * kDegree;
    if (raw.elevation_deg) options.view.elevation = *raw.elevation_deg * kDegree;
    if (raw.distance_mm) options.view.distance = *raw.distance_mm * kMillimetre;
    if (!raw.target_mm.empty()) {
        options.view.target_W =
            kMillimetre * Eigen::Vector3d(raw.target_mm[0], raw.target_mm[1], raw.target_mm[2]);
    }
    if (raw.timeout_s && !raw.offscreen && raw.command.empty() && !raw.measure_s)
        throw UserError("--timeout-s needs --offscreen, --command or --measure-s");
    const std::chrono::seconds timeout =
        raw.timeout_s ? std::chrono::seconds(*raw.timeout_s) : kDefaultTimeout;
    if (raw.offscreen) convertOffscreen(raw, timeout, options);
    if (raw.measure_s) {
        options.measure = MeasureOptions{.time = std::chrono::seconds(*raw.measure_s),
                                         .is_in_window = raw.measures_in_window,
                                         .timeout = timeout};
    }
    if (options.holds_tool && (raw.offscreen || raw.measure_s || !raw.command.empty()))
        throw UserError("--hold-tool needs a window: leave out --offscreen, --measure-s and --command");
    const bool may_hold = mayHoldTool(options.subscriber.role);
    if (options.holds_tool && !may_hold)
        throw UserError("--hold-tool needs --role operator or instructor: a viewer only looks");
    if (options.subscriber.is_trainee &&
        (raw.offscreen || raw.measure_s || !raw.command.empty() || !may_hold))
        throw UserError("--trainee needs a window, and --role operator or instructor");
    if (!options.sound_wav.empty() && (!options.has_effects || raw.measure_s || !raw.command.empty()))
        throw UserError(
            "--sound-wav needs a viewer with effects: leave out --no-effects, --measure-s and --command");
    if (!raw.command.empty()) options.command = CommandOptions{raw.command, timeout};
    options.connect = connectOptions(raw.connect);
    options.relay = relayOptions(raw.relay);
    options.serve = serveOptions(raw.serve);
    if (options.serve) {
        options.serve->via = relayPlace(raw.relay);
        options.serve->domain = options.subscriber.domain;
        options.serve->session = options.subscriber.session;
    }
    return options;
}

}  // namespace

ServerSought soughtOf(const ClientOptions& options) {
    if (options.subscriber.remote) {
        ServerSought sought;
        sought.gateway = options.subscriber.remote->name();
        return sought;
    }
    const std::string& profile = options.network.profile;
    const std::string shown = !profile.empty()                ? profile
                              : std::getenv("CYCLONEDDS_URI") ? "as CYCLONEDDS_URI says"
                                                              : "one-pc";
    return {.session = options.subscriber.session,
            .domain = options.subscriber.domain,
            .profile = shown,
            .interface = options.network.interface,
            .is_on_lan = dds::isLanProfile(profile),
            .is_any_session = options.chooses_session,
            .lock = !options.network.secure.empty()        ? HudLock::kClosed
                    : dds::isOpenToOthers(options.network) ? HudLock::kOpen
                                                           : HudLock::kNone};
}

std::string serverQuestion(const SubscriberOptions& subscriber) {
    if (subscriber.remote) return "does the gateway " + subscriber.remote->name() + " hear a haptic_server?";
    return "is a haptic_server running in domain " + std::to_string(subscriber.domain) + ", session " +
           std::to_string(subscriber.session) + "?";
}

std::optional<ClientOptions> parseOptions(int argc, const char* const* argv) {
    ClientOptions options;
    options.subscriber.name = loginName();
    RawOptions raw;
    CLI::App app{
        "Shows the session of a haptic_server in a window, or off screen as pictures "
        "(docs/reference/viewer.md)."};
    addOptions(app, raw, options);
    if (!parseCommandLine(app, argc, argv, "render_client")) return std::nullopt;
    return convert(raw, options);
}

}  // namespace bonemill
