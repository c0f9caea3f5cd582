// Plays the milling sound through OpenAL, on a thread of its own. Without a sound device, or when it goes
// away, there is one warning in the log, and silence.
//
// The thread allocates nothing per block itself and holds no lock: the newest load
// reaches it through atomics.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "render_client/sound/milling_synth.h"

namespace bonemill {

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

}  // namespace bonemill
