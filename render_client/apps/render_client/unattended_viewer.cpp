#include "render_client/apps/render_client/unattended_viewer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "common/base/user_error.h"
#include "common/commands/command_text.h"
#include "common/rt/clock.h"
#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/hand/window/glfw_window.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/offscreen/video_file.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestFrame{33};  // a picture at least so often, news or not

void setUp(RenderScene& scene, const ClientOptions& options) {
    scene.setViewWish(options.view);
    scene.settings() = options.settings;
}

void draw(RenderScene& scene, const ClientOptions& options) {
    scene.draw(options.width, options.height,
               textScale(options.width, options.height, options.settings.text_scale));
}

struct Measured {
    CutToScreen cuts;
    LatencyHistogram upload;  // taking, decoding and uploading what had come, where nodes were in it
    LatencyHistogram render;  // from the start of the drawing to the finished picture
    uint64_t frames = 0;
    double seconds = 0;
    double processor_s = 0;  // of all threads
};

Measured drawFor(std::chrono::seconds time, const ClientOptions& options, const GlApi& gl, RenderScene& scene,
                 SceneFeed& feed) {
    Measured measured;
    feed.watchCuts(&measured.cuts);
    const int64_t start_ns = monotonicNowNs();
    const std::clock_t start_of_work = std::clock();
    const Clock::time_point end = Clock::now() + time;
    while (Clock::now() < end && !stopRequested()) {
        feed.subscriber().waitForData(kLongestFrame);
        const int64_t update_ns = monotonicNowNs();
        const uint64_t uploads = scene.uploads().nodes;
        feed.update();
        const int64_t draw_ns = monotonicNowNs();
        if (scene.uploads().nodes != uploads) measured.upload.record(draw_ns - update_ns);
        draw(scene, options);
        gl.Finish();
        measured.render.record(monotonicNowNs() - draw_ns);
        measured.cuts.hasShown(CutToScreen::nowNs());
        ++measured.frames;
    }
    feed.watchCuts(nullptr);
    measured.seconds = secondsOfNs(monotonicNowNs() - start_ns);
    measured.processor_s = double(std::clock() - start_of_work) / CLOCKS_PER_SEC;
    return measured;
}

// Makes buffers, compiles shaders, draws the whole model, and what has come meanwhile.
void warmUp(const ClientOptions& options, const GlApi& gl, RenderScene& scene, SceneFeed& feed) {
    constexpr int kPictures = 3;
    for (int n = 0; n < kPictures; ++n) {
        feed.update();
        draw(scene, options);
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
    setUp(scene, options);
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
        "{\"width\":%d,\"height\":%d,\"nodes\":%zu,\"triangles\":%zu,\"frames\":%llu,\"frame_rate_hz\":%.2f,"
        "\"processor_ms_per_frame\":%.2f,",
        options.width, options.height, scene.nodeCount(), scene.triangleCount(),
        (unsigned long long)measured.frames, double(measured.frames) / measured.seconds,
        millisecondsOfNs(1e9 * measured.processor_s / double(std::max<uint64_t>(measured.frames, 1))));
    printTimes("upload_ms", measured.upload);
    std::printf(",");
    printTimes("render_ms", measured.render);
    std::printf(",");
    printTimes("cut_to_viewer_ms", measured.cuts.arrivals());
    std::printf(",");
    printTimes("cut_to_screen_ms", measured.cuts.times());
    std::printf(",\"uploaded_nodes\":%llu,\"uploaded_bytes\":%llu}\n",
                (unsigned long long)(after.nodes - before.nodes),
                (unsigned long long)(after.bytes - before.bytes));
}

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
        setUp(scene_, options);
        scene_.setSought(soughtOf(options));
        feed_.takePart();
    }

    void run() {
        waitForServer(feed_, options_);
        const uint64_t most = wish_.seconds > 0 ? uint64_t(std::ceil(wish_.seconds * wish_.fps)) : UINT64_MAX;
        if (wish_.led_from_s)
            lead(*wish_.led_from_s, most);
        else
            follow(most);
    }

  private:
    static constexpr std::chrono::milliseconds kLook{3};
    static constexpr double kEndS = 1e-2;

    void follow(uint64_t most) {
        VideoClock clock(wish_.fps, isReplay());
        uint64_t drawn = 0, frames = 0;
        while (frames < most) {
            feed_.update();
            if (isOver()) break;
            const uint64_t due = clock.due(now(), expected());
            if (due == 0) {
                feed_.updateUntil(Clock::now() + kLook, stopRequested);
                continue;
            }
            draw(scene_, options_);
            const uint64_t shown = std::min(due, most - frames);
            file_.add(context_.read(), shown);
            frames += shown;
            ++drawn;
        }
        finish(frames, drawn);
    }

    // After each picture the replay is led on by its time, so that none is missing, however slow the PC.
    void lead(double first_s, uint64_t most) {
        uint64_t frames = 0;
        while (frames < most && leadTo(first_s + double(frames) / wish_.fps)) {
            draw(scene_, options_);
            file_.add(context_.read(), 1);
            ++frames;
        }
        finish(frames, frames);
    }

    // False: there is no such moment any more. Throws std::runtime_error if the server does not do it.
    bool leadTo(double session_s) {
        topics::Command command;
        command.mutable_replay()->set_seek_s(session_s);
        feed_.subscriber().sendCommand(command);
        while (true) {
            feed_.updateUntil(Clock::now() + kLook, stopRequested);
            if (isOver()) return false;
            for (const CommandOutcome& outcome : feed_.subscriber().takeOutcomes())
                if (!outcome.isDone()) throw std::runtime_error(outcomeText(outcome));
            if (std::abs(now() - session_s) < 0.5 / wish_.fps && feed_.isComplete()) return true;
        }
    }

    void finish(uint64_t frames, uint64_t drawn) {
        if (drawn == 0) return;  // stopped before there was anything to see: no video
        file_.finish();
        std::printf("{\"video\":\"%s\",\"frames\":%llu,\"drawn\":%llu,\"seconds\":%.3f}\n",
                    wish_.path.c_str(), (unsigned long long)frames, (unsigned long long)drawn,
                    double(frames) / wish_.fps);
    }

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

    // A replay's clock waits for who was kept from listening, by a long picture or a busy PC: its server is
    // gone only when it does not come back.
    bool isGone() {
        if (feed_.subscriber().hasServer())
            missed_since_.reset();
        else if (!missed_since_)
            missed_since_ = Clock::now();
        const auto patience = isReplay() ? SceneSubscriber::kServerTimeout : std::chrono::seconds(0);
        return missed_since_ && Clock::now() - *missed_since_ >= patience;
    }

    bool isOver() { return stopRequested() || isGone() || isAtEnd(); }

    const ClientOptions& options_;
    const VideoOptions& wish_;
    VideoFile file_;
    OsmesaContext context_;
    RenderScene scene_;
    SceneFeed feed_;
    Clock::time_point looked_ = Clock::now();
    std::optional<Clock::time_point> missed_since_;  // the server
};

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

void runVideo(const ClientOptions& options) {
    VideoViewer(options).run();
}

void runOffscreen(const ClientOptions& options) {
    const OffscreenOptions& wish = *options.offscreen;
    makeFolder(wish.directory);
    const OsmesaContext context(options.width, options.height);
    spdlog::info("off screen, {}", context.gl().describe());
    RenderScene scene(context.gl(), options.has_effects);
    setUp(scene, options);
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
    feed.update();  // the sound lasts until the end
    sound.finish();
}

}  // namespace bonemill
