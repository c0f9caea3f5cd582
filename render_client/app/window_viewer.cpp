#include "render_client/app/window_viewer.h"

#include <spdlog/spdlog.h>

#include "render_client/app/scene_feed.h"
#include "render_client/app/stop_signal.h"
#include "render_client/window/glfw_window.h"

namespace bonemill {
namespace {

constexpr std::chrono::milliseconds kMinimisedPause{50};

void apply(const WindowInput& input, RenderScene& scene, SceneFeed& feed) {
    OrbitCamera& camera = scene.camera();
    camera.orbit(input.orbit_azimuth, input.orbit_elevation);
    camera.pan(input.pan_right, input.pan_up);
    camera.zoom(input.zoom_factor);
    if (input.reset_view) scene.resetView();
    if (input.toggle_help) scene.toggleHelp();
    if (input.reset_volume) {
        topics::Command command;
        command.set_reset_volume(true);
        feed.subscriber().sendCommand(command);
    }
}

void logOutcomes(SceneFeed& feed) {
    for (const CommandOutcome& outcome : feed.subscriber().takeOutcomes()) {
        spdlog::log(outcome.is_acknowledged ? spdlog::level::info : spdlog::level::warn, "command {}: {}",
                    outcome.sequence, outcome.result);
    }
}

}  // namespace

void runWindow(const ClientOptions& options) {
    GlfwWindow window(options.width, options.height, "bonemill");
    spdlog::info("window, {}", window.gl().describe());
    RenderScene scene(window.gl());
    scene.setViewOverrides(options.view);
    SceneFeed feed(options.subscriber, scene);
    while (!window.shouldClose() && !stopRequested()) {
        apply(window.takeInput(), scene, feed);
        feed.update();
        logOutcomes(feed);
        const int width = window.pixelWidth(), height = window.pixelHeight();
        if (width == 0 || height == 0) {
            feed.updateUntil(std::chrono::steady_clock::now() + kMinimisedPause, stopRequested);
            continue;
        }
        scene.draw(width, height, window.contentScale());
        window.show();
    }
}

}  // namespace bonemill
