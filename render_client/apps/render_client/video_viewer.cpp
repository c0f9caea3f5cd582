#include "render_client/apps/render_client/video_viewer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/look/hud/text_scale.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/offscreen/video_clock.h"
#include "render_client/look/offscreen/video_file.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

// A video begins with something to see.
void waitForServer(SceneFeed& feed, const ClientOptions& options) {
    const OffscreenOptions& wish = *options.offscreen;
    if (wish.wait_complete) return waitUntilComplete(feed, options.subscriber, wish.timeout);
    const auto has_begun = [&] { return feed.subscriber().hasServer() && feed.subscriber().status(); };
    feed.updateUntil(Clock::now() + wish.timeout, [&] { return has_begun() || stopRequested(); });
    if (!has_begun() && !stopRequested())
        throw std::runtime_error("no server within " + std::to_string(wish.timeout.count()) +
                                 " s: " + serverQuestion(options.subscriber));
}

class VideoViewer {
  public:
    explicit VideoViewer(const ClientOptions& options)
        : options_(options),
          wish_(*options.offscreen->video),
          file_(wish_.path, options.width, options.height, wish_.fps),
          context_(options.width, options.height),
          scene_(context_.gl(), options.has_effects),
          feed_(options.subscriber, scene_) {
        spdlog::info("off screen, {}", context_.gl().describe());
        scene_.setViewWish(options.view);
        scene_.settings() = options.settings;
        scene_.setSought(soughtOf(options));
        feed_.takePart();
    }

    void run() {
        waitForServer(feed_, options_);
        VideoClock clock(wish_.fps, isReplay());
        const uint64_t most = wish_.seconds > 0 ? uint64_t(std::ceil(wish_.seconds * wish_.fps)) : UINT64_MAX;
        uint64_t drawn = 0, frames = 0;
        while (frames < most && !isOver()) {
            feed_.update();
            const uint64_t due = clock.due(now(), expected());
            if (due == 0) {
                feed_.updateUntil(Clock::now() + kLook, stopRequested);
                continue;
            }
            scene_.draw(options_.width, options_.height,
                        textScale(options_.width, options_.height, options_.settings.text_scale));
            const uint64_t shown = std::min(due, most - frames);
            file_.add(context_.read(), shown);
            frames += shown;
            ++drawn;
        }
        if (drawn == 0) return;  // stopped before there was anything to see: no video
        file_.finish();
        std::printf("{\"video\":\"%s\",\"frames\":%llu,\"drawn\":%llu,\"seconds\":%.3f}\n",
                    wish_.path.c_str(), (unsigned long long)frames, (unsigned long long)drawn,
                    double(frames) / wish_.fps);
    }

  private:
    static constexpr std::chrono::milliseconds kLook{3};
    static constexpr double kEndS = 1e-2;

    bool isReplay() { return feed_.subscriber().status() && feed_.subscriber().status()->has_replay(); }

    // Of a replay the recording's clock: a slow PC plays it slowly, and the video lacks nothing.
    double now() {
        const auto& tool = feed_.subscriber().toolState();
        if (isReplay()) return tool ? tool->session_s() : 0;
        return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    }

    // Since the call before, at the replay's speed.
    double expected() {
        const Clock::time_point before = std::exchange(looked_, Clock::now());
        const double passed_s = std::chrono::duration<double>(looked_ - before).count();
        return isReplay() ? passed_s * feed_.subscriber().status()->replay().speed() : passed_s;
    }

    // A replay that has come to its end holds there.
    bool isAtEnd() {
        if (!isReplay()) return false;
        const topics::Replay& replay = feed_.subscriber().status()->replay();
        return !replay.is_playing() && now() >= replay.length_s() - kEndS;
    }

    bool isOver() { return stopRequested() || !feed_.subscriber().hasServer() || isAtEnd(); }

    const ClientOptions& options_;
    const VideoOptions& wish_;
    VideoFile file_;
    OsmesaContext context_;
    RenderScene scene_;
    SceneFeed feed_;
    Clock::time_point looked_ = Clock::now();
};

}  // namespace

void runVideo(const ClientOptions& options) {
    VideoViewer(options).run();
}

}  // namespace bonemill
