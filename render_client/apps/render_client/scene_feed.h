// Moves what the subscriber received into the scene that is drawn and heard. It belongs to the thread of the
// OpenGL context.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/hand/controls/announcing.h"
#include "render_client/link/subscribe/cut_to_screen.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/look/render_scene/node_intake.h"
#include "render_client/sound/sound_output.h"

namespace bonemill {

// SIGINT and SIGTERM are a question that the render loop asks: from now on the signals only make
// stopRequested() true. It is called once, from main().
void catchStopSignals();
bool stopRequested() noexcept;

// The milling sound of the session is heard from the loudspeakers, into a WAV file, or both. A scene that
// does not list milling_sound makes no synth, no thread and no sound device; its WAV file is silent.
struct SoundOutputs {
    bool is_played = false;
    std::filesystem::path wav;  // empty: none
};

class SoundFeed {
  public:
    // Throws UserError when the file cannot be made.
    explicit SoundFeed(const SoundOutputs& outputs);

    // Takes the newest scene info and tool state, and how long ago (s) the call before
    // was: as much is written.
    void update(const std::optional<topics::SceneInfo>& info, const std::optional<topics::ToolState>& tool,
                bool is_heard, double seconds);
    // Completes the file. Throws UserError when it could not be written.
    void finish();

  private:
    void follow(const scene::Effects& wish);
    void writeWav(double seconds);

    SoundOutputs outputs_;
    std::string wish_text_;  // of the message that the synths were made from
    std::unique_ptr<SoundPlayer> player_;
    std::unique_ptr<MillingSynth> wav_synth_;
    std::optional<WavFile> wav_;
    double due_ = 0;  // samples
    std::vector<float> block_;
};

class SceneFeed {
  public:
    // Throws UserError when the DDS domain cannot be joined. The scene must outlive the feed.
    SceneFeed(const SubscriberOptions& options, RenderScene& scene)
        : subscriber_(options), scene_(scene), nodes_(scene) {}

    // Takes everything that has arrived; waits as SceneSubscriber::poll() does.
    void update();
    // Goes on updating until then, so that nothing piles up. Ends early when `stop` says so.
    template <class Stop>
    void updateUntil(std::chrono::steady_clock::time_point end, Stop&& stop);

    // Returns true when the scene shows exactly the server's model, and the tool if the server has
    // one to show.
    bool isComplete() const;

    // From now on the others' lists show this viewer, and the scene shows the others. A window does both
    // itself: it points, and measures its rate.
    void takePart() { takes_part_ = true; }

    // From now on `sound` hears what the scene sounds like. It must outlive the feed.
    void sound(SoundFeed* sound) { sound_ = sound; }

    // Tells `cuts` of every cut that the next picture will show first.
    void watchCuts(CutToScreen* cuts) { cuts_ = cuts; }

    SceneSubscriber& subscriber() { return subscriber_; }

  private:
    bool hasWholeModel() const { return subscriber_.isComplete() && nodes_.refusedCount() == 0; }
    void showSceneInfo();
    void showStructures();
    void showRemarks();
    void updateConnection();
    void announce();
    void advanceEffects();

    SceneSubscriber subscriber_;
    RenderScene& scene_;
    NodeIntake nodes_;
    CutToScreen* cuts_ = nullptr;
    SoundFeed* sound_ = nullptr;
    std::chrono::steady_clock::time_point advanced_ = std::chrono::steady_clock::now();
    bool takes_part_ = false;
    AnnounceClock announce_clock_;
    std::pair<uint64_t, uint32_t> shown_info_;  // epoch and revision of the scene info that was passed on
    uint64_t shown_structures_ = 0;             // SceneSubscriber::structureChanges() that were passed on
    uint64_t shown_remarks_ = 0;                // the same of SceneSubscriber::remarkChanges()
    uint64_t structures_epoch_ = 0;             // of theirs
    uint64_t complete_epoch_ = 0;               // server run whose model was complete once; 0: none
    bool had_server_ = false;
};

// Returns early after a stop signal. Throws std::runtime_error with a question for the user when the model
// was not complete in time.
void waitUntilComplete(SceneFeed& feed, const SubscriberOptions& options, std::chrono::seconds timeout);

// Returns when all of the scan that the last picture wanted has arrived, at once where it wanted none; early
// after a stop signal or this time.
void waitForScan(SceneFeed& feed, RenderScene& scene, std::chrono::seconds timeout);

template <class Stop>
void SceneFeed::updateUntil(std::chrono::steady_clock::time_point end, Stop&& stop) {
    constexpr std::chrono::milliseconds kSlice{20};  // how late `stop` may be noticed
    while (!stop()) {
        const auto left = end - std::chrono::steady_clock::now();
        if (left <= left.zero()) return;
        subscriber_.waitForData(std::min<std::chrono::nanoseconds>(left, kSlice));
        update();
    }
}

}  // namespace bonemill
