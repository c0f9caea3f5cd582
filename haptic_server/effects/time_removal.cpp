#include "haptic_server/effects/time_removal.h"

namespace bonemill {

TimeRemoval::TimeRemoval(const TimeRemovalConfig& config, const BoneModel& bone, double largest_burr_radius,
                         size_t most_cells)
    : HapticEffect(0),
      milling_({.removal_rate = config.rate, .addition_rate = 0, .most_cells = most_cells}, bone.volume,
               bone.lattice, largest_burr_radius) {}

void TimeRemoval::mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept {
    const bool is_stalled = tick.tool->burr.speed != 0 && tick.spin_speed == 0;
    if (!tick.is_pedal_down || is_stalled) return;
    milling_.setShape(tick.shape);
    milling_.setBurrRadius(tick.tool->burr.radius);
    result.include(milling_.apply(bone.volume, bone.lattice, bone.shell, tick.X_VT.position, -1, tick.dt));
}

}  // namespace bonemill
