// This is the thesis' removal: what is inside the burr goes at a rate of density per time, however hard it
// is pressed.
//
// In the gradient law the tool is moved through what the tick will cut: the surface that it meets on the burr
// lies as far back as milling will bring it by the end of the tick (milling/timed_milling.h: removalSpeed()).
// So the burr feels no bone up to that speed, and bone that is as stiff as ever beyond it, whatever the
// tick's length. After the force went out, what the burr swept on its way is removed.
#include <algorithm>
#include <cmath>

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {
namespace {

void squaredDistances(const float* x, const float* y, const float* z, size_t count,
                      const Eigen::Vector3f& from, float* out) noexcept {
    const float from_x = from.x(), from_y = from.y(), from_z = from.z();
    for (size_t i = 0; i < count; ++i) {
        const float dx = x[i] - from_x, dy = y[i] - from_y, dz = z[i] - from_z;
        out[i] = dx * dx + dy * dy + dz * dz;
    }
}

// Moves each place away from `from` by a share of its distance, on one axis.
void goOn(float* at, float from, const float* share, size_t count) noexcept {
    for (size_t i = 0; i < count; ++i) at[i] += share[i] * (at[i] - from);
}

class TimeRemoval final : public HapticEffect {
  public:
    TimeRemoval(const TimeRemovalConfig& config, const BoneModel& bone, const EffectRoom& room)
        : HapticEffect(kScales),
          longest_way_(room.longest_way),
          milling_({.removal_rate = config.rate,
                    .addition_rate = 0,
                    .most_cells = room.most_cells,
                    .longest_way = room.longest_way},
                   bone.volume, bone.lattice, room.largest_burr_radius) {}
    void begin(EffectTick& tick) noexcept override {
        const bool is_stalled = tick.tool->burr.speed != 0 && tick.spin_speed == 0;
        is_cutting_ = tick.is_pedal_down && !is_stalled;
        milling_.setShape(tick.shape);
        milling_.setBurrRadius(tick.tool->burr.radius);
        milling_.setThrift(tick.milling_thrift);
    }
    double scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                 const ToolField& tool, const Pose& X_VT) noexcept override {
        if (!is_cutting_) return 1;
        const auto radius = float(tick.tool->burr.radius + burrSlack(tool));
        const auto recession = float(milling_.removalSpeed() * tick.milled_dt);
        const float reach_squared = (radius + recession) * (radius + recession);
        const Eigen::Vector3f p_OB = (X_VT.position - origin_V).cast<float>();
        const Eigen::Vector3f axis = (X_VT.rotation * Eigen::Vector3d::UnitY()).cast<float>();
        const Pose X_TV = X_VT.inverse();
        constexpr size_t kBatch = 64;
        float distance[kBatch], share[kBatch];
        for (size_t first = 0; first < candidates.count; first += kBatch) {
            const size_t count = std::min(kBatch, candidates.count - first);
            float *x = &candidates.x[first], *y = &candidates.y[first], *z = &candidates.z[first];
            squaredDistances(x, y, z, count, p_OB, distance);
            for (size_t i = 0; i < count; ++i) {
                const bool is_reached = distance[i] < reach_squared && distance[i] > 0;
                distance[i] = std::sqrt(distance[i]);
                share[i] = is_reached ? recession / distance[i] : 0;
            }
            for (size_t i = 0; i < count; ++i) {
                // Outside of the burr, on the hand's side, the shaft may be nearer.
                if (!(share[i] > 0 && distance[i] > radius)) continue;
                const Eigen::Vector3f at(x[i], y[i], z[i]);
                if (!((at - p_OB).dot(axis) > 0)) continue;
                const Eigen::Vector3d p_V = origin_V + at.cast<double>();
                if (distance[i] - radius > float(tool.sample(X_TV * p_V).distance)) share[i] = 0;
            }
            goOn(x, p_OB.x(), share, count), goOn(y, p_OB.y(), share, count), goOn(z, p_OB.z(), share, count);
        }
        return 1;
    }
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override {
        if (!is_cutting_) return;
        const bool is_swept = tick.shape == MillingShape::kSubVoxel;
        const BurrWay way(tick.X_VT_milled.position, tick.X_VT.position, is_swept ? longest_way_ : 0);
        result.include(milling_.apply(bone.volume, bone.lattice, bone.shell, way, -1, tick.milled_dt));
    }

  private:
    double longest_way_;  // m
    TimedMilling milling_;
    bool is_cutting_ = false;
};

}  // namespace

std::unique_ptr<HapticEffect> TimeRemovalConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<TimeRemoval>(*this, needs.bone, needs.room);
}

}  // namespace bonemill
