#include "render_client/apps/render_client/measure_viewer.h"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "common/rt/clock.h"
#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/hand/window/glfw_window.h"
#include "render_client/look/hud/text_scale.h"
#include "render_client/look/offscreen/osmesa_context.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestFrame{33};  // a picture at least so often, news or not

struct Measured {
    CutToScreen cuts;
    LatencyHistogram render;  // from the start of the drawing to the finished picture
    uint64_t frames = 0;
    double seconds = 0;
};

Measured drawFor(std::chrono::seconds time, const ClientOptions& options, const GlApi& gl, RenderScene& scene,
                 SceneFeed& feed) {
    Measured measured;
    feed.watchCuts(&measured.cuts);
    const int64_t start_ns = monotonicNowNs();
    const Clock::time_point end = Clock::now() + time;
    while (Clock::now() < end && !stopRequested()) {
        feed.subscriber().waitForData(kLongestFrame);
        feed.update();
        const int64_t draw_ns = monotonicNowNs();
        scene.draw(options.width, options.height,
                   textScale(options.width, options.height, options.settings.text_scale));
        gl.Finish();
        measured.render.record(monotonicNowNs() - draw_ns);
        measured.cuts.hasShown(CutToScreen::nowNs());
        ++measured.frames;
    }
    feed.watchCuts(nullptr);
    measured.seconds = secondsOfNs(monotonicNowNs() - start_ns);
    return measured;
}

// Makes buffers, compiles shaders, draws the whole model, and what has come meanwhile.
void warmUp(const ClientOptions& options, const GlApi& gl, RenderScene& scene, SceneFeed& feed) {
    constexpr int kPictures = 3;
    for (int n = 0; n < kPictures; ++n) {
        feed.update();
        scene.draw(options.width, options.height,
                   textScale(options.width, options.height, options.settings.text_scale));
        gl.Finish();
    }
}

void printTimes(const char* key, const LatencyHistogram& times) {
    if (times.count() == 0) {
        std::printf("\"%s\":null", key);
        return;
    }
    const auto ms = [&](double percent) { return millisecondsOfNs(double(times.percentileNs(percent))); };
    std::printf("\"%s\":{\"count\":%llu,\"p50\":%.2f,\"p99\":%.2f,\"max\":%.2f}", key,
                (unsigned long long)times.count(), ms(50), ms(99), millisecondsOfNs(double(times.maxNs())));
}

void measure(const ClientOptions& options, const GlApi& gl) {
    spdlog::info("{}", gl.describe());
    RenderScene scene(gl, options.has_effects);
    scene.setViewWish(options.view);
    scene.settings() = options.settings;
    if (options.chooses_quality && gl.isSoftware()) scene.settings().quality = Quality::kQuick;
    SceneFeed feed(options.subscriber, scene);
    waitUntilComplete(feed, options.subscriber, options.measure->timeout);
    warmUp(options, gl, scene, feed);
    waitForScan(feed, scene, options.measure->timeout);
    warmUp(options, gl, scene, feed);
    const UploadCount before = scene.uploads();
    const Measured measured = drawFor(options.measure->time, options, gl, scene, feed);
    const UploadCount after = scene.uploads();
    std::printf(
        "{\"width\":%d,\"height\":%d,\"nodes\":%zu,\"triangles\":%zu,\"frames\":%llu,\"frame_rate_hz\":%.2f,",
        options.width, options.height, scene.nodeCount(), scene.triangleCount(),
        (unsigned long long)measured.frames, double(measured.frames) / measured.seconds);
    printTimes("render_ms", measured.render);
    std::printf(",");
    printTimes("cut_to_viewer_ms", measured.cuts.arrivals());
    std::printf(",");
    printTimes("cut_to_screen_ms", measured.cuts.times());
    std::printf(",\"uploaded_nodes\":%llu,\"uploaded_bytes\":%llu}\n",
                (unsigned long long)(after.nodes - before.nodes),
                (unsigned long long)(after.bytes - before.bytes));
}

}  // namespace

void runMeasurement(const ClientOptions& options) {
    if (options.measure->is_in_window) {
        const GlfwWindow window(options.width, options.height, "bonemill", kWithoutDisplay);
        measure(options, window.gl());
    } else {
        const OsmesaContext context(options.width, options.height);
        measure(options, context.gl());
    }
}

}  // namespace bonemill
