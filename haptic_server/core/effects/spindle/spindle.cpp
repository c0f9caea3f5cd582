// A motor turns the burr: it runs up when the pedal goes down and brakes when it comes up, droops under load
// and stalls when that is too much:
//   J dΩ/dt = clamp(k (Ω₀ − Ω), ±T) − M sgn(Ω) − c Ω,   M = μ Σ F ρ over contacts (burr_speed.h),
// in one implicit Euler step a tick: k may be as stiff as one likes. M is dry friction, from the last tick's
// contacts: it stops the burr, at exactly 0, and never drives it. A burr that stands under load takes
// as much of M as the motor gives. Sets EffectTick::spin_speed and axis_load.
//
// It is RT-safe, for the tick thread only.
#include <algorithm>
#include <cmath>

#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {
namespace {

constexpr double kStandsBelow = 0.05;    // of the full speed
constexpr double kShortestStall = 0.05;  // s
constexpr double kSlowStart = 2;         // a run-up to that takes this many times as long under load

double motorTorque(const SpindleConfig& config, double wanted, double speed) noexcept {
    return std::clamp(config.droop * (wanted - speed), -config.max_torque, config.max_torque);
}

class Spindle final : public HapticEffect {
  public:
    explicit Spindle(const SpindleConfig& config) noexcept : HapticEffect(kReadsContacts), config_(config) {}

    // The motor goes on turning whatever happens to the bone.
    void restart(Restart why) noexcept override {
        if (why != Restart::kOtherTool) return;
        speed_ = 0;
        held_ = 0;
        stands_for_ = 0;
    }
    void begin(EffectTick& tick) noexcept override {
        const double wanted = tick.is_pedal_down ? tick.tool->burr.speed : 0;
        const double load = frictionOf(tick) * tick.burr_load.moment;
        speed_ = config_.speedAfter(speed_, wanted, load, tick.dt);
        held_ = speed_ == 0 ? std::clamp(motorTorque(config_, wanted, 0), -load, load)
                            : std::copysign(load, speed_);
        watch(wanted, tick.dt);
        tick.spin_speed = speed_;
        tick.axis_load = held_;
    }
    void finish(EffectTick& tick) noexcept override {
        // The pedal is down and the burr has stood nearly still for longer than its run-up explains.
        if (stands_for_ > longest_start_) tick.record.events |= kEventSpindleStalled;
        tick.record.axis_torque = float(std::abs(held_));
    }

  private:
    void watch(double wanted, double dt) noexcept {
        const double slow = kStandsBelow * std::abs(wanted);
        longest_start_ = std::max(kShortestStall, kSlowStart * config_.inertia * slow / config_.max_torque);
        stands_for_ = std::abs(speed_) < slow && held_ != 0 ? stands_for_ + dt : 0;  // not in the air
    }

    SpindleConfig config_;
    double speed_ = 0;          // rad/s
    double held_ = 0;           // N·m: what the bone takes, with the sign of the spin
    double stands_for_ = 0;     // s
    double longest_start_ = 0;  // s
};

}  // namespace

// Its residual rises with the new speed throughout, so that there is one root: at 0, where dry friction takes
// up what is needed, or with friction against the spin, where the motor is or is not at its limit.
double SpindleConfig::speedAfter(double speed, double wanted, double load, double dt) const noexcept {
    const double momentum = inertia / dt * speed;
    const double drive = momentum + motorTorque(*this, wanted, 0);
    if (std::abs(drive) <= load) return 0;
    const double driven = momentum - std::copysign(load, drive);
    const double linear = (driven + droop * wanted) / (inertia / dt + droop + drag);
    const double limited = motorTorque(*this, wanted, linear);
    if (std::abs(limited) < max_torque) return linear;
    return (driven + limited) / (inertia / dt + drag);
}

std::unique_ptr<HapticEffect> SpindleConfig::make(const EffectNeeds&) const {
    return std::make_unique<Spindle>(*this);
}

}  // namespace bonemill
