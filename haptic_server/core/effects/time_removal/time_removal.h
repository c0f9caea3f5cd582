// This is the thesis' removal: what is inside the burr goes at a rate of density per time, however hard it
// is pressed.
//
// In the gradient law the tool is moved through what the tick will cut: the surface that it meets on the burr
// lies as far back as milling will bring it by the end of the tick (milling/timed_milling.h: removalSpeed()).
// So the burr feels no bone up to that speed, and bone that is as stiff as ever beyond it, whatever the
// tick's length. After the force went out, what the burr swept on its way is removed.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {

struct EffectRoom;

class TimeRemoval final : public HapticEffect {
  public:
    TimeRemoval(const TimeRemovalConfig& config, const BoneModel& bone, const EffectRoom& room);
    void begin(EffectTick& tick) noexcept override;
    double scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                 const ToolField& tool, const Pose& X_VT) noexcept override;
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override;

  private:
    double longest_way_;  // m
    TimedMilling milling_;
    bool is_cutting_ = false;
};

}  // namespace bonemill
