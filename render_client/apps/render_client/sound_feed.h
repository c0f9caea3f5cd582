// The milling sound of the session is heard from the loudspeakers, into a WAV file, or both. A scene that
// does not list milling_sound makes no synth, no thread and no sound device; its WAV file is silent.
//
// It belongs to the thread of the viewer.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/sound/sound_player.h"
#include "render_client/sound/wav_file.h"

namespace bonemill {

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

}  // namespace bonemill
