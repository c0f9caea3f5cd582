// Cutting heats the bone: a share of the friction power μ_c |Ω| Σ F ρ of the burr's contacts goes into the
// bone where they touch, spreads (heat_grid.h), and leaves it to irrigation while the pedal is down, to the
// dry surroundings and to the blood. The rest of the power goes with the chips.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/thermal/heat_grid.h"

namespace bonemill {

class Thermal final : public HapticEffect {
  public:
    // Keeps a reference to the bone. dt is the time of a tick, in s.
    Thermal(const ThermalConfig& config, const BoneModel& bone, double dt);
    void restart(Restart why) noexcept override {
        if (why == Restart::kBonePutBack) heat_.noteChangeEverywhere();
        if (why == Restart::kScanPutBack) heat_.forget();
    }
    void mill(EffectTick&, BoneModel&, MillingResult& result) noexcept override {
        heat_.noteChange(result.changed);
    }
    void finish(EffectTick& tick) noexcept override;

  private:
    void putIn(const EffectTick& tick) noexcept;

    ThermalConfig config_;
    HeatGrid heat_;
    size_t turn_ = 0;
};

}  // namespace bonemill
