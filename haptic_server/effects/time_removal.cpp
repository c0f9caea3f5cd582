#include "haptic_server/effects/time_removal.h"

#include <cmath>

#include "haptic_server/effects/make_effects.h"

namespace bonemill {

TimeRemoval::TimeRemoval(const TimeRemovalConfig& config, const BoneModel& bone, const EffectRoom& room)
    : HapticEffect(kScales),
      longest_way_(room.longest_way),
      milling_({.removal_rate = config.rate,
                .addition_rate = 0,
                .most_cells = room.most_cells,
                .longest_way = room.longest_way},
               bone.volume, bone.lattice, room.largest_burr_radius) {}

void TimeRemoval::begin(EffectTick& tick) noexcept {
    const bool is_stalled = tick.tool->burr.speed != 0 && tick.spin_speed == 0;
    is_cutting_ = tick.is_pedal_down && !is_stalled;
    milling_.setShape(tick.shape);
    milling_.setBurrRadius(tick.tool->burr.radius);
}

double TimeRemoval::scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                          const ToolField& tool, const Pose& X_VT) noexcept {
    if (!is_cutting_) return 1;
    const auto radius = float(tick.tool->burr.radius + burrSlack(tool));
    const auto recession = float(milling_.removalSpeed() * tick.dt);
    const Eigen::Vector3f p_OB = (X_VT.position - origin_V).cast<float>();
    for (size_t n = 0; n < candidates.count; ++n) {
        const Eigen::Vector3f r = candidates.position(n) - p_OB;
        const float distance = r.norm();
        if (!(distance > 0 && distance < radius + recession)) continue;
        // Outside of the burr the shaft may be nearer.
        const bool is_on_burr =
            distance < radius ||
            distance - radius <=
                float(tool.sample(X_VT.inverse() * (origin_V + candidates.position(n).cast<double>()))
                          .distance);
        if (!is_on_burr) continue;
        const Eigen::Vector3f back = recession / distance * r;
        candidates.x[n] += back.x();
        candidates.y[n] += back.y();
        candidates.z[n] += back.z();
    }
    return 1;
}

void TimeRemoval::mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept {
    if (!is_cutting_) return;
    const bool is_swept = tick.shape == MillingShape::kSubVoxel;
    const BurrWay way(tick.X_VT_start.position, tick.X_VT.position, is_swept ? longest_way_ : 0);
    result.include(milling_.apply(bone.volume, bone.lattice, bone.shell, way, -1, tick.dt));
}

}  // namespace bonemill
