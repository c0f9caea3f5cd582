// Reads the command line of render_client. What is shown at the start has its options in view_options.h.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/dds/network.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud_lines.h"
#include "render_client/viewer_options/web_options.h"
#include "render_client/web/gateway/gateway_options.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill {

// The program waits so long for a server or its whole model, unless it is told.
inline constexpr std::chrono::seconds kDefaultTimeout{60};

// What to do where no window can be opened.
inline constexpr char kWithoutDisplay[] =
    "Without a display use: render_client --offscreen --frames N --out DIR";

// A video instead of single pictures.
struct VideoOptions {
    std::filesystem::path path;  // .mp4
    double fps = 30;
    double seconds = 0;                // 0: until the session ends
    std::optional<double> led_from_s;  // leads a replay from this moment on, from picture to picture
};

struct OffscreenOptions {
    uint32_t frames = 1;
    std::filesystem::path directory;
    std::chrono::milliseconds interval{500};
    bool wait_complete = false;
    std::chrono::seconds timeout = kDefaultTimeout;  // of wait_complete, and of a video for its server
    std::optional<VideoOptions> video;
};

// Instead of a viewer, this is asked for, once there is a server.
struct CommandOptions {
    std::string text;                                // subscribe/command_words.h
    std::chrono::seconds timeout = kDefaultTimeout;  // of waiting for the server
};

// Instead of a viewer, the program measures what drawing costs.
struct MeasureOptions {
    std::chrono::seconds time{10};
    bool is_in_window = false;                       // otherwise off screen
    std::chrono::seconds timeout = kDefaultTimeout;  // of waiting for the whole model
};

// The command line says this, and not what a window remembers.
struct Said {
    bool size = false, quality = false, camera = false, text_scale = false;
};

struct ClientOptions {
    SubscriberOptions subscriber;
    bool chooses_session =
        false;  // none was given: a window takes the only one, or offers those that are there
    bool lists_sessions = false;  // prints them instead
    dds::NetworkOptions network;
    ViewWish view;
    ViewSettings settings;            // what is shown at the start
    bool holds_tool = false;          // with the mouse, as soon as it can be
    bool has_effects = true;          // of the scene, seen and heard
    std::filesystem::path sound_wav;  // empty: none
    std::string class_folder;         // of this PC's server; empty: not known
    std::string launcher;             // deploy/bonemill, for replays and invitations; empty: none
    std::string recording;            // that is replayed here, for clips; empty: not known
    bool chooses_quality = true;      // by speed in a window; kQuick where OpenGL in software is measured
    std::string language;             // of what is written; empty: in a window the user's, else English
    Said said;
    int width = 1280;  // pixels
    int height = 800;
    std::optional<OffscreenOptions> offscreen;  // none given: a window
    std::optional<CommandOptions> command;
    std::optional<MeasureOptions> measure;
    std::optional<ConnectOptions> connect;         // instead of DDS
    std::optional<gateway::GatewayOptions> serve;  // instead of a viewer
    std::optional<RelayOptions> relay;             // instead of a viewer
    std::string log_level = "info";
};

// Returns which server the viewer looks for, in words for the user.
ServerSought soughtOf(const ClientOptions& options);

// Returns what to ask a user to whom no server answers.
std::string serverQuestion(const SubscriberOptions& subscriber);

// Returns nothing after --help (already printed). Throws UserError.
std::optional<ClientOptions> parseOptions(int argc, const char* const* argv);

}  // namespace bonemill
