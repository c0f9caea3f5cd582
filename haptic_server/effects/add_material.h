// The burr lays down material (free form) at a rate of density per time where it is held.
#pragma once

#include "haptic_server/effects/effect_configs.h"
#include "haptic_server/effects/haptic_effect.h"
#include "haptic_server/milling/timed_milling.h"

namespace bonemill {

class AddMaterial final : public HapticEffect {
  public:
    // There is room for burrs up to largest_burr_radius, in m. most_cells is that of MillingConfig.
    AddMaterial(const AddMaterialConfig& config, const BoneModel& bone, double largest_burr_radius,
                size_t most_cells);
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override;

  private:
    TimedMilling milling_;
};

}  // namespace bonemill
