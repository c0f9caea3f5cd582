// The turning burr shakes the hand with A sin φ along T's x axis, which is at right angles to the spin. Teeth
// pass at some kHz, which a loop of 1000 Hz cannot render; the rotation is felt, at a frequency that it can:
//   dφ/dt = 2π f,   f = |Ω|/2π within 50 .. 400 Hz and at most 0.4/dt,
//   A → min(max_amplitude, amplitude_per_force · μ Σ F) with a time constant of 10 ms,
// less below 50 turns/s in proportion, and a diamond burr less by its factor. In the air it is
// exactly nothing. It acts on the hand only: the simulated tool does not shake. It is RT-safe, for
// the tick thread only.
#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/math/pinned_math.h"
#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {
namespace {

constexpr double kHighestOfRate = 0.4;  // of 1/dt
constexpr double kNothing = 1e-4;       // N

class BurrVibration final : public HapticEffect {
  public:
    explicit BurrVibration(const BurrVibrationConfig& config) noexcept
        : HapticEffect(kReadsContacts), config_(config) {}

    void restart(Restart) noexcept override { amplitude_ = 0; }
    void begin(EffectTick& tick) noexcept override {
        phase_ = std::fmod(
            phase_ + kTurn * BurrVibrationConfig::frequency(tick.spin_speed, tick.dt) * tick.dt, kTurn);
        const double wanted = wantedAmplitude(tick);
        amplitude_ += tick.dt / (BurrVibrationConfig::kSmoothing + tick.dt) * (wanted - amplitude_);
        if (wanted == 0 && amplitude_ < kNothing) amplitude_ = 0;
    }
    void addToHand(const EffectTick& tick, Wrench& wrench_V) noexcept override {
        if (amplitude_ == 0) return;
        wrench_V.force +=
            amplitude_ * pinned::sin(phase_) * (tick.X_VT_start.rotation * Eigen::Vector3d::UnitX());
    }

  private:
    double wantedAmplitude(const EffectTick& tick) const noexcept {
        const Burr& burr = tick.tool->burr;
        const double slow = std::min(1.0, std::abs(tick.spin_speed) / (kTurn * BurrVibrationConfig::kLowest));
        const double grit = burr.grit == BurrGrit::kDiamond ? config_.diamond_factor : 1;
        const double by_load = config_.amplitude_per_force * frictionOf(tick) * tick.burr_load.force;
        return slow * grit * std::min(config_.max_amplitude, by_load);
    }

    BurrVibrationConfig config_;
    double phase_ = 0;      // rad
    double amplitude_ = 0;  // N
};

}  // namespace

double BurrVibrationConfig::frequency(double spin_speed, double dt) noexcept {
    return std::min(std::clamp(std::abs(spin_speed) / kTurn, kLowest, kHighest), kHighestOfRate / dt);
}

std::unique_ptr<HapticEffect> BurrVibrationConfig::make(const EffectNeeds&) const {
    return std::make_unique<BurrVibration>(*this);
}

}  // namespace bonemill
