#include "haptic_server/core/effects/burr_vibration/burr_vibration.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

constexpr double kNothing = 1e-4;  // N

}  // namespace

double BurrVibration::frequency(double spin_speed, double dt) noexcept {
    return std::min(std::clamp(std::abs(spin_speed) / kTurn, kLowest, kHighest), kHighestOfRate / dt);
}

double BurrVibration::wantedAmplitude(const EffectTick& tick) const noexcept {
    const Burr& burr = tick.tool->burr;
    const double slow = std::min(1.0, std::abs(tick.spin_speed) / (kTurn * kLowest));
    const double grit = burr.grit == BurrGrit::kDiamond ? config_.diamond_factor : 1;
    const double by_load = config_.amplitude_per_force * burr.friction * tick.burr_load.force;
    return slow * grit * std::min(config_.max_amplitude, by_load);
}

void BurrVibration::begin(EffectTick& tick) noexcept {
    phase_ = std::fmod(phase_ + kTurn * frequency(tick.spin_speed, tick.dt) * tick.dt, kTurn);
    const double wanted = wantedAmplitude(tick);
    amplitude_ += tick.dt / (kSmoothing + tick.dt) * (wanted - amplitude_);
    if (wanted == 0 && amplitude_ < kNothing) amplitude_ = 0;
}

void BurrVibration::addToHand(const EffectTick& tick, Wrench& wrench_V) noexcept {
    if (amplitude_ == 0) return;
    wrench_V.force +=
        amplitude_ * pinned::sin(phase_) * (tick.X_VT_start.rotation * Eigen::Vector3d::UnitX());
}

std::unique_ptr<HapticEffect> BurrVibrationConfig::make(const EffectNeeds&) const {
    return std::make_unique<BurrVibration>(*this);
}

}  // namespace bonemill
