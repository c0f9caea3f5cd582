// Where the milling sound goes: to the loudspeakers, and into a file.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "render_client/sound/milling_synth.h"

namespace bonemill {

// Plays the milling sound through OpenAL, on a thread of its own. Without a sound device, or when it goes
// away, there is one warning in the log, and silence.
//
// The thread allocates nothing per block itself and holds no lock: the newest load
// reaches it through atomics.
class SoundPlayer {
  public:
    explicit SoundPlayer(const scene::MillingSound& wish);
    ~SoundPlayer();  // ends with a short fade
    SoundPlayer(const SoundPlayer&) = delete;
    SoundPlayer& operator=(const SoundPlayer&) = delete;

    // May be called from any thread.
    void setLoad(const SoundLoad& load, bool is_heard) noexcept;
    bool isPlaying() const noexcept { return is_playing_.load(std::memory_order_relaxed); }

  private:
    class Output;
    void run();
    void takeLoad() noexcept;

    MillingSynth synth_;
    // Each value is atomic by itself: a load that is half new for one block is not heard.
    std::atomic<double> spin_speed_{0}, burr_force_{0}, cutting_power_{0};
    std::atomic<bool> is_heard_{true}, must_stop_{false}, is_playing_{false};
    std::thread thread_;
};

// It is a mono 16-bit WAV file that grows while it is written (RIFF; IBM, Microsoft: Multimedia Programming
// Interface 1.0, 1991). It is for one thread. The header says the length after finish() or destruction.
class WavFile {
  public:
    // Throws UserError when the file cannot be made.
    WavFile(const std::filesystem::path& path, int sample_rate);
    ~WavFile();
    WavFile(const WavFile&) = delete;
    WavFile& operator=(const WavFile&) = delete;

    // Samples go from -1 to 1; louder ones are cut. After 4 GiB nothing is added.
    void write(std::span<const float> samples);
    // Throws UserError when something could not be written.
    void finish();

  private:
    void writeHeader();

    std::filesystem::path path_;
    std::ofstream file_;
    uint32_t sample_rate_;
    uint64_t bytes_ = 0;
    std::vector<char> packed_;
    bool is_finished_ = false;
};

}  // namespace bonemill
