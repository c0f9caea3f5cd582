// A motor turns the burr: it runs up when the pedal goes down and brakes when it comes up, droops under load
// and stalls when that is too much:
//   J dΩ/dt = clamp(k (Ω₀ − Ω), ±T) − M sgn(Ω) − c Ω,   M = μ_c Σ F ρ over contacts (burr_speed.h),
// in one implicit Euler step a tick: k may be as stiff as one likes. M is dry friction, from the last tick's
// contacts: it stops the burr, at exactly 0, and never drives it. A burr that stands under load takes
// as much of M as the motor gives. Sets EffectTick::spin_speed and axis_load.
//
// It is RT-safe, for the tick thread only.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

class Spindle final : public HapticEffect {
  public:
    explicit Spindle(const SpindleConfig& config) noexcept : HapticEffect(kReadsContacts), config_(config) {}

    void restart(Restart why) noexcept override;
    void begin(EffectTick& tick) noexcept override;
    void finish(EffectTick& tick) noexcept override;

    // The spindle is stalled when the pedal is down and the burr has stood nearly still for longer than its
    // run-up explains.
    bool isStalled() const noexcept { return stands_for_ > longest_start_; }

    // Returns the speed after dt in rad/s, from the `speed` before, the `wanted` Ω₀ and dry friction of at
    // most `load` N·m.
    static double advanced(const SpindleConfig& config, double speed, double wanted, double load,
                           double dt) noexcept;

  private:
    void watch(double wanted, double dt) noexcept;

    SpindleConfig config_;
    double speed_ = 0;          // rad/s
    double held_ = 0;           // N·m: what the bone takes, with the sign of the spin
    double stands_for_ = 0;     // s
    double longest_start_ = 0;  // s
};

}  // namespace bonemill
