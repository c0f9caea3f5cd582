#include "haptic_server/core/effects/spindle/spindle.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kStandsBelow = 0.05;    // of the full speed
constexpr double kShortestStall = 0.05;  // s
constexpr double kSlowStart = 2;         // a run-up to that takes this many times as long under load

double motorTorque(const SpindleConfig& config, double wanted, double speed) noexcept {
    return std::clamp(config.droop * (wanted - speed), -config.max_torque, config.max_torque);
}

}  // namespace

// The motor goes on turning whatever happens to the bone.
void Spindle::restart(Restart why) noexcept {
    if (why != Restart::kOtherTool) return;
    speed_ = 0;
    held_ = 0;
    stands_for_ = 0;
}

// Its residual rises with the new speed throughout, so that there is one root: at 0, where dry friction takes
// up what is needed, or with friction against the spin, where the motor is or is not at its limit.
double Spindle::advanced(const SpindleConfig& config, double speed, double wanted, double load,
                         double dt) noexcept {
    const double momentum = config.inertia / dt * speed;
    const auto motor = [&](double at) { return motorTorque(config, wanted, at); };
    const double drive = momentum + motor(0);
    if (std::abs(drive) <= load) return 0;
    const double driven = momentum - std::copysign(load, drive);
    const double linear =
        (driven + config.droop * wanted) / (config.inertia / dt + config.droop + config.drag);
    const double limited = motor(linear);
    if (std::abs(limited) < config.max_torque) return linear;
    return (driven + limited) / (config.inertia / dt + config.drag);
}

void Spindle::begin(EffectTick& tick) noexcept {
    const Burr& burr = tick.tool->burr;
    const double wanted = tick.is_pedal_down ? burr.speed : 0;
    const double load = burr.friction * tick.burr_load.moment;
    speed_ = advanced(config_, speed_, wanted, load, tick.dt);
    held_ =
        speed_ == 0 ? std::clamp(motorTorque(config_, wanted, 0), -load, load) : std::copysign(load, speed_);
    watch(wanted, tick.dt);
    tick.spin_speed = speed_;
    tick.axis_load = held_;
}

void Spindle::watch(double wanted, double dt) noexcept {
    const double slow = kStandsBelow * std::abs(wanted);
    longest_start_ = std::max(kShortestStall, kSlowStart * config_.inertia * slow / config_.max_torque);
    stands_for_ = std::abs(speed_) < slow && held_ != 0 ? stands_for_ + dt : 0;  // not in the air
}

void Spindle::finish(EffectTick& tick) noexcept {
    if (isStalled()) tick.record.events |= kEventSpindleStalled;
    tick.record.axis_torque = float(std::abs(held_));
}

std::unique_ptr<HapticEffect> SpindleConfig::make(const EffectNeeds&) const {
    return std::make_unique<Spindle>(*this);
}

}  // namespace bonemill
