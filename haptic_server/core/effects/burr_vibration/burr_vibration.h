// The turning burr shakes the hand with A sin φ along T's x axis, which is at right angles to the spin. Teeth
// pass at some kHz, which a loop of 1000 Hz cannot render; the rotation is felt, at a frequency that it can:
//   dφ/dt = 2π f,   f = |Ω|/2π within 50 .. 400 Hz and at most 0.4/dt,
//   A → min(max_amplitude, amplitude_per_force · μ_c Σ F) with a time constant of 10 ms,
// less below 50 turns/s in proportion, and a diamond burr less by its factor. In the air it is
// exactly nothing. It acts on the hand only: the simulated tool does not shake. It is RT-safe, for
// the tick thread only.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

class BurrVibration final : public HapticEffect {
  public:
    static constexpr double kLowest = 50, kHighest = 400;  // Hz
    static constexpr double kHighestOfRate = 0.4;          // of 1/dt
    static constexpr double kSmoothing = 10e-3;            // s

    explicit BurrVibration(const BurrVibrationConfig& config) noexcept
        : HapticEffect(kReadsContacts), config_(config) {}

    void restart(Restart) noexcept override { amplitude_ = 0; }
    void begin(EffectTick& tick) noexcept override;
    void addToHand(const EffectTick& tick, Wrench& wrench_V) noexcept override;

    static double frequency(double spin_speed, double dt) noexcept;  // Hz

  private:
    double wantedAmplitude(const EffectTick& tick) const noexcept;

    BurrVibrationConfig config_;
    double phase_ = 0;      // rad
    double amplitude_ = 0;  // N
};

}  // namespace bonemill
