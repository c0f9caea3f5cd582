// This is the tangential force with which bone holds on to the turning burr, and its torque about the burr's
// axis: the sixth degree of freedom. Each contact on the burr, of normal force F, rubs at the speed v_s = Ω a
// × r + v (v the tool's own motion there, tangential parts) and pulls with
//   F_t = −s μ_c F v_s / √(|v_s|² + v_ε²),   |v_s| the mean over its patch (burr_speed.h),
// so that about the axis M Ω = μ_c Σ F v_c · v_c / √(v_c² + v_ε²), v_c = |Ω| ρ. s fades from 1 to 0 as
// the burr comes to rest. What stands still sticks, and is surface_friction's; but a burr that a spindle
// cannot turn passes the motor's torque on, by forces in the direction of the spin in proportion to F:
//   F_t = −(1 − s) (L/Σ F ρ) F (a × r)/ρ,   L the spindle's axis_load.
//
// It comes from the last tick's contacts, smoothed with smoothing_time. In the solve it is a constant wrench
// for the spin, and for the tool's own motion a damper: force that follows a velocity of the last tick would
// shake a tool in a narrow place. It is RT-safe, for the tick thread only.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

class CuttingForce final : public HapticEffect {
  public:
    explicit CuttingForce(const CuttingForceConfig& config) noexcept
        : HapticEffect(kReadsContacts | kHasEnergy), config_(config) {}

    void restart(Restart) noexcept override;
    void begin(EffectTick& tick) noexcept override;
    EnergyTerm energy(const EffectTick& tick, const Pose& X_VT) const noexcept override;
    void finish(EffectTick& tick) noexcept override;

  private:
    // The pull acts on the tool, about the tool point, in V.
    struct Pull {
        Wrench of_spin;
        Matrix6d damping = Matrix6d::Zero();  // N·s/m, N·s, N·m·s: against the tool's own motion
    };
    Pull pullOf(const EffectTick& tick) const noexcept;

    CuttingForceConfig config_;
    Pull pull_;
};

}  // namespace bonemill
