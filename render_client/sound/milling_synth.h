// Makes the sound of the motor and of the burr in bone, from speed and load.
//
// The motor has harmonics of the rotation frequency f = |Ω|/2π, up to kHighest, and two gear tones above
// them; it gets louder with the speed. Cutting is band-passed noise, its strength modulated at the tooth
// passing frequency flutes·f, and gets louder with the square root of the cutting power. Where the burr
// is nearer to a protected structure than kThinWall, the band rises and narrows: surgeons listen for that
// before they break through. All levels and the frequencies follow their targets with kSmoothing, and every
// tone keeps its phase, so nothing clicks.
//
// Units are rad/s, N, W; samples lie in -1 .. 1. It is for one thread, and RT-safe after construction
// (no memory, no lock). The same settings and loads at the same samples give the same samples, in blocks
// of any length.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "proto/scene.pb.h"

namespace bonemill {

// The sound follows these loads. Whatever is not a number counts as 0; the bounds are
// those of effect_input.h.
struct SoundLoad {
    double spin_speed = 0;     // rad/s, either way
    double burr_force = 0;     // N
    double cutting_power = 0;  // W
    double wall = 1;           // m from the burr to a protected structure
};

class MillingSynth {
  public:
    static constexpr int kSampleRate = 48000;    // Hz
    static constexpr double kSmoothing = 0.025;  // s
    static constexpr double kHighest = 16000;    // Hz of a tone
    static constexpr double kThinWall = 2e-3;    // m, from which on a wall sounds higher
    static constexpr double kNoiseMiddle = 2600, kThinNoiseMiddle = 4700;  // Hz: thick, and no wall left

    explicit MillingSynth(const scene::MillingSound& wish);

    // The load counts from the next sample on. Without is_heard the sound fades out.
    void setLoad(const SoundLoad& load, bool is_heard = true) noexcept;
    void render(std::span<float> samples) noexcept;

    double frequency() const noexcept { return frequency_; }  // of the rotation now, Hz

  private:
    static constexpr size_t kTones = 8;
    struct Targets {
        double frequency = 0;  // Hz
        double motor = 0, cutting = 0;
        double thinness = 0;  // 0 .. 1
    };
    void updateTones() noexcept;
    void updateBand() noexcept;
    float nextSample() noexcept;
    double noise() noexcept;

    double volume_, idle_level_, full_frequency_, full_power_, flutes_;
    Targets targets_;
    double frequency_ = 0, motor_ = 0, cutting_ = 0, thinness_ = 0;
    std::array<double, kTones> phases_{}, levels_{}, wanted_levels_{};  // phases in turns
    double tooth_phase_ = 0;
    double low_ = 0, band_ = 0, pitch_ = 0, width_ = 0;  // of the state variable filter
    uint32_t random_ = 0x9e3779b9u;
    size_t to_update_ = 0;  // samples until the levels of the tones follow again
};

}  // namespace bonemill
