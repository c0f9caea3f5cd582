#include "render_client/apps/render_client/offscreen_viewer.h"

#include <spdlog/spdlog.h>

#include <cinttypes>
#include <cstdio>
#include <iostream>

#include "common/base/user_error.h"
#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/look/hud/text_scale.h"
#include "render_client/look/offscreen/osmesa_context.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

void makeFolder(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw UserError("--out " + folder.string() + ": " + failure.message());
}

// Returns the training's warnings as a JSON array; they are printable UTF-8 already.
std::string warningsOf(const topics::Training& training) {
    std::string list;
    for (const std::string& warning : training.warnings()) {
        list += list.empty() ? "\"" : ",\"";
        for (const char sign : warning) {
            if (sign == '"' || sign == '\\') list += '\\';
            list += sign;
        }
        list += '"';
    }
    return "[" + list + "]";
}

// Describes what the picture shows. It is called before the drawing, which may take longer than
// the server's time-out.
std::string describe(uint32_t frame, const std::string& file, const RenderScene& scene, SceneFeed& feed) {
    const SceneSubscriber& subscriber = feed.subscriber();
    const uint64_t tick = subscriber.toolState() ? subscriber.toolState()->tick() : 0;
    const auto& status = subscriber.status();
    const std::string warnings =
        status && status->has_training() ? ",\"warnings\":" + warningsOf(status->training()) : "";
    char line[512];
    std::snprintf(line, sizeof line,
                  "{\"frame\":%u,\"file\":\"%s\",\"nodes\":%zu,\"triangles\":%zu,"
                  "\"node_digest\":\"%016" PRIx64 "\",\"complete\":%s,\"server\":%s,\"epoch\":%" PRIu64
                  ",\"tick\":%" PRIu64 ",\"uploaded_nodes\":%" PRIu64 ",\"uploaded_bytes\":%" PRIu64,
                  frame, file.c_str(), scene.nodeCount(), scene.triangleCount(), subscriber.digest().value(),
                  feed.isComplete() ? "true" : "false", subscriber.hasServer() ? "true" : "false",
                  subscriber.epoch(), tick, scene.uploads().nodes, scene.uploads().bytes);
    return line + warnings + "}";
}

void draw(RenderScene& scene, const ClientOptions& options) {
    scene.draw(options.width, options.height,
               textScale(options.width, options.height, options.settings.text_scale));
}

}  // namespace

void runOffscreen(const ClientOptions& options) {
    const OffscreenOptions& wish = *options.offscreen;
    makeFolder(wish.directory);
    const OsmesaContext context(options.width, options.height);
    spdlog::info("off screen, {}", context.gl().describe());
    RenderScene scene(context.gl(), options.has_effects);
    scene.setViewWish(options.view);
    scene.settings() = options.settings;
    scene.setSought(soughtOf(options));
    SceneFeed feed(options.subscriber, scene);
    feed.takePart();
    SoundFeed sound({.is_played = false, .wav = options.sound_wav});
    if (!options.sound_wav.empty()) feed.sound(&sound);

    Clock::time_point due = Clock::now() + wish.interval;
    if (wish.wait_complete) {
        waitUntilComplete(feed, options.subscriber, wish.timeout);
        if (options.settings.showsScan()) {
            draw(scene, options);  // now it is known what is wanted of the scan
            waitForScan(feed, scene, wish.timeout);
        }
        due = Clock::now();
    }
    for (uint32_t frame = 0; frame < wish.frames; ++frame) {
        feed.updateUntil(due, stopRequested);
        if (stopRequested()) break;
        due = Clock::now() + wish.interval;
        feed.update();
        char name[32];
        std::snprintf(name, sizeof name, "frame_%04u.png", frame);
        const std::string description = describe(frame, name, scene, feed);
        draw(scene, options);
        writePng(context.read(), wish.directory / name);
        std::cout << description << std::endl;
    }
    sound.finish();
}

}  // namespace bonemill
