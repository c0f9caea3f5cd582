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
#pragma once

#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

class VirtualFixture final : public HapticEffect {
  public:
    VirtualFixture(const VirtualFixtureConfig& config, std::shared_ptr<const DistanceField> field);
    void begin(EffectTick& tick) noexcept override;
    EnergyTerm energy(const EffectTick& tick, const Pose& X_VT) const noexcept override;
    void addToHand(const EffectTick& tick, Wrench& wrench_V) noexcept override;

  private:
    VirtualFixtureConfig config_;
    std::shared_ptr<const DistanceField> field_;
    BurrProbes burr_;
    double sharpness_ = 0;  // β, 1/m
    double scale_ = 1;      // of the hand's force, now
    bool is_near_ = false;
};

}  // namespace bonemill
