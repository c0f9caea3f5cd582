// There is dry friction where the tool does not cut: on the shaft, and on a burr that stands. The tool sticks
// by a spring to where it touched, and slips when that pulls with more than μ F.
//
// The spring's stretch is a twist u of the tool (x of the tool point, rotation vector θ). A contact group of
// force F at r, tangential part P, is stretched by s = |P^½ (u_x + u_θ × r)|, and
//   E(u) = Σ μ F H(s),   H(s) = s²/2w up to w, s − w/2 beyond (Huber),   w = μ ΣF / k:
// convex, so that the solve finds stick and slip alike; contacts as the last tick left them. All contacts
// together stick with stiffness k, whatever they carry, so that a load that goes up and down does not make
// the tool creep. At the tick's end u follows plastically: it shrinks until the load-weighted RMS of s is at
// most w, and forgets what stretches no contact (a ball that rolls). When the contacts change so that the
// same u would store more than friction has been given, it shrinks as well: friction never drives.
//
// Elastoplastic presliding: Dupont, Hayward, Armstrong, Altpeter, Single state elastoplastic friction models,
// IEEE Trans. Automatic Control 2002; here it has an energy. It is RT-safe, for the tick thread only.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/surface_friction/contact_groups.h"

namespace bonemill {

class SurfaceFriction final : public HapticEffect {
  public:
    explicit SurfaceFriction(const SurfaceFrictionConfig& config) noexcept
        : HapticEffect(kReadsContacts | kHasEnergy), config_(config) {}

    void restart(Restart) noexcept override { forget(); }
    void begin(EffectTick& tick) noexcept override;
    EnergyTerm energy(const EffectTick& tick, const Pose& X_VT) const noexcept override;
    void finish(EffectTick& tick) noexcept override;

    const Vector6d& stretch() const noexcept { return stretch_; }  // u: m, rad

  private:
    void forget() noexcept;
    EnergyTerm at(const Vector6d& stretch) const noexcept;  // by u
    double meanStretch(const Vector6d& stretch) const noexcept;
    double slipWidth() const noexcept {
        return config_.coefficient * groups_.force() / config_.presliding_stiffness;
    }
    void giveWay() noexcept;
    void forgetFreeMotion() noexcept;

    SurfaceFrictionConfig config_;
    ContactGroups groups_;
    Vector6d stretch_ = Vector6d::Zero();
    double stored_ = 0;  // J, at the last tick's end
    double given_ = 0;   // J: what changes of the contacts took from the spring, and may give back
};

}  // namespace bonemill
