// Protected structures have a prohibited region around them: an energy pushes the simulated tool out of it.
//
// With d_i the distances of the burr's probes, d their smooth minimum -log(Σ exp(-β d_i)) / β (for a ball:
// its own distance) and x = d₀ - d > 0:
//   E = ½ k x²,   from x = F_m/k on linear with slope F_m,
// force and torque minus its gradient by the tool's pose, so that no closed path gains energy; stiffness
// (F/x) J Jᵀ, J the gradient of d (Gauss-Newton, positive semi-definite).
//
// hand_force_scale s: of a conservative force, s times it is conservative only while s does not change; less
// discards energy, more would give some. So s falls when the burr comes into the region, and rises only when
// the hand feels almost nothing.
#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"
#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {
namespace {

// This is a share of the burr's radius: the smooth minimum of n equal distances is log(n) times this less
// than they are.
constexpr double kSmoothing = 0.05;
// A hand does not feel these; the energy that a spring of 1 N/mm holds then is 1.25 µJ.
constexpr double kUnfeltForce = 0.05;   // N
constexpr double kUnfeltTorque = 1e-3;  // N·m
constexpr double kScaleTime = 0.02;     // s in which the scale goes from 1 to 0

class VirtualFixture final : public HapticEffect {
  public:
    VirtualFixture(const VirtualFixtureConfig& config, std::shared_ptr<const DistanceField> field)
        : HapticEffect(kHasEnergy), config_(config), field_(std::move(field)) {}
    void begin(EffectTick& tick) noexcept override {
        const Burr& burr = tick.tool->burr;
        burr_ = BurrProbes(burr);
        sharpness_ = 1 / (kSmoothing * burr.radius);
        is_near_ = nearestStructure(*field_, burr_, tick.X_VT_start).distance < config_.distance;
    }
    EnergyTerm energy(const EffectTick&, const Pose& X_VT) const noexcept override {
        std::array<DistanceSample, BurrProbes::kMax> samples;
        size_t count = 0;
        double least = field_->reach();
        for (const BurrProbe& probe : burr_) {
            DistanceSample& sample = samples[count++] = field_->smoothAt(X_VT * probe.center_T);
            sample.distance -= probe.radius;
            least = std::min(least, sample.distance);
        }
        const double margin = pinned::log(double(count)) / sharpness_;
        if (least - margin >= config_.distance) return {};

        double weights = 0;
        Vector6d slope = Vector6d::Zero();
        count = 0;
        for (const BurrProbe& probe : burr_) {
            const DistanceSample& sample = samples[count++];
            const double weight = pinned::exp(-sharpness_ * (sample.distance - least));
            weights += weight;
            slope.head<3>() += weight * sample.gradient_V;
            slope.tail<3>() += weight * (X_VT.rotation * probe.center_T).cross(sample.gradient_V);
        }
        slope /= weights;
        const double inside = config_.distance - (least - pinned::log(weights) / sharpness_);
        if (inside <= 0) return {};
        const double soft = config_.max_force / config_.stiffness;
        const double force = std::min(config_.stiffness * inside, config_.max_force);
        EnergyTerm term;
        term.energy = inside < soft ? 0.5 * force * inside : force * (inside - 0.5 * soft);
        term.wrench = {force * slope.head<3>(), force * slope.tail<3>()};
        term.stiffness = (force / inside) * slope * slope.transpose();
        return term;
    }
    void addToHand(const EffectTick& tick, Wrench& wrench_V) noexcept override {
        if (config_.hand_force_scale == 1) return;
        const double step = tick.dt / kScaleTime;
        const bool is_free = wrench_V.force.norm() < kUnfeltForce && wrench_V.torque.norm() < kUnfeltTorque;
        if (is_near_)
            scale_ = std::max(config_.hand_force_scale, scale_ - step);
        else if (is_free)
            scale_ = std::min(1.0, scale_ + step);
        wrench_V.force *= scale_;
        wrench_V.torque *= scale_;
    }

  private:
    VirtualFixtureConfig config_;
    std::shared_ptr<const DistanceField> field_;
    BurrProbes burr_;
    double sharpness_ = 0;  // β, 1/m
    double scale_ = 1;      // of the hand's force, now
    bool is_near_ = false;
};

}  // namespace

std::unique_ptr<HapticEffect> VirtualFixtureConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<VirtualFixture>(*this, needs.all.protected_field);
}

}  // namespace bonemill
