// The burr lays material down (free form) where the add button is held.
//
// In the gradient law it comes behind the burr (milling/deposit.h): all that the burr has swept, as soon as
// the tool has left it, however fast that was. The tool is never in what it lays down and feels nothing of it
// but what it comes back to. The thesis' law does as printed: what is inside the burr gains density at a
// rate.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/deposit.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {

struct EffectRoom;

class AddMaterial final : public HapticEffect {
  public:
    AddMaterial(const AddMaterialConfig& config, const BoneModel& bone, const EffectRoom& room);
    void restart(Restart) noexcept override { deposit_.forget(); }
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override;

  private:
    ToolPlace placeOf(const EffectTick& tick) noexcept;

    double longest_way_;  // m
    TimedMilling milling_;
    Deposit deposit_;
    const ToolModel* tool_ = nullptr;  // that is measured
    double tool_radius_ = 0;           // m
};

}  // namespace bonemill
