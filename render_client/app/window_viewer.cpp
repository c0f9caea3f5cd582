#include "render_client/app/window_viewer.h"

#include <spdlog/spdlog.h>

#include "render_client/app/scene_feed.h"
#include "render_client/app/stop_signal.h"
#include "render_client/scene/accuracy_keys.h"
#include "render_client/subscribe/command_text.h"
#include "render_client/window/glfw_window.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMinimisedPause{50};
constexpr std::chrono::seconds kNoticeTime{4};

void send(const WindowInput& input, SceneSubscriber& subscriber) {
    topics::Command command;
    if (input.reset_volume) {
        command.set_reset_volume(true);
        subscriber.sendCommand(command);
    }
    if (input.accuracy_key) {
        command.set_set_accuracy(std::string(kAccuracyOfKey[*input.accuracy_key]));
        subscriber.sendCommand(command);
    }
}

void apply(const WindowInput& input, RenderScene& scene) {
    OrbitCamera& camera = scene.camera();
    camera.orbit(input.orbit_azimuth, input.orbit_elevation);
    camera.pan(input.pan_right, input.pan_up);
    camera.zoom(input.zoom_factor);
    if (input.reset_view) scene.resetView();
    if (input.toggle_help) scene.settings().show_help = !scene.settings().show_help;
}

// Says how commands ended: in the log, and over the picture for a while.
class OutcomeNotice {
  public:
    void update(SceneSubscriber& subscriber, RenderScene& scene) {
        for (const CommandOutcome& outcome : subscriber.takeOutcomes()) {
            const std::string text = outcomeText(outcome);
            spdlog::log(outcome.isDone() ? spdlog::level::info : spdlog::level::warn, "{}", text);
            scene.setNotice(HudNotice{text, outcome.isDone() ? HudTone::kGood : HudTone::kWarning});
            end_ = Clock::now() + kNoticeTime;
        }
        if (Clock::now() >= end_) scene.setNotice(std::nullopt);
    }

  private:
    Clock::time_point end_;
};

}  // namespace

void runWindow(const ClientOptions& options) {
    GlfwWindow window(options.width, options.height, "bonemill");
    spdlog::info("window, {}", window.gl().describe());
    RenderScene scene(window.gl());
    scene.setViewOverrides(options.view);
    SceneFeed feed(options.subscriber, scene);
    OutcomeNotice notice;
    while (!window.shouldClose() && !stopRequested()) {
        const WindowInput input = window.takeInput();
        apply(input, scene);
        send(input, feed.subscriber());
        feed.update();
        notice.update(feed.subscriber(), scene);
        const int width = window.pixelWidth(), height = window.pixelHeight();
        if (width == 0 || height == 0) {
            feed.updateUntil(Clock::now() + kMinimisedPause, stopRequested);
            continue;
        }
        scene.draw(width, height, window.contentScale());
        window.show();
    }
}

}  // namespace bonemill
