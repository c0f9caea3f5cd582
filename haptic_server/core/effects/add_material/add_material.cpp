// The burr lays material down (free form) where the add button is held.
//
// In the gradient law it comes behind the burr (milling/deposit.h): all that the burr has swept, as soon as
// the tool has left it, however fast that was. The tool is never in what it lays down and feels nothing of it
// but what it comes back to. The thesis' law does as printed: what is inside the burr gains density at a
// rate.
#include <algorithm>

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/deposit.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {
namespace {

// How thick the tool is at most, over the burr's size and beyond as far again; it is round about its axis.
double thickestNear(const ToolModel& tool, double burr_radius) noexcept {
    constexpr int kPlaces = 12, kSteps = 16;
    const ToolField& field = tool.field({});
    double thickest = burr_radius;
    for (int n = 0; n < kPlaces; ++n) {
        const double y = 4 * burr_radius * n / kPlaces;
        double r = thickest;
        for (int step = 0; step < kSteps; ++step) {
            const double outside = field.distanceBound({r, y, 0});
            if (outside >= 0) break;
            r -= outside;
        }
        thickest = std::max(thickest, r);
    }
    return thickest;
}

class AddMaterial final : public HapticEffect {
  public:
    AddMaterial(const AddMaterialConfig& config, const BoneModel& bone, const EffectRoom& room)
        : HapticEffect(0),
          longest_way_(room.longest_way),
          milling_({.removal_rate = 0, .addition_rate = config.rate, .most_cells = room.most_cells},
                   bone.volume, bone.lattice, room.largest_burr_radius),
          deposit_(bone, {.rate = config.rate,
                          .largest_burr_radius = room.largest_burr_radius,
                          .longest_way = room.longest_way,
                          .most_cells = room.most_cells}) {}
    void restart(Restart) noexcept override { deposit_.forget(); }
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override {
        if (tick.is_pedal_down) deposit_.forget();
        if (!tick.may_mill) return;
        const double radius = tick.tool->burr.radius;
        if (tick.shape == MillingShape::kVoxelCentres) {
            if (!tick.is_add_wanted) return;
            milling_.setBurrRadius(radius);
            return result.include(milling_.apply(bone.volume, bone.lattice, bone.shell, tick.X_VT.position,
                                                 +1, tick.milled_dt));
        }
        if (tick.is_add_wanted)
            deposit_.owe(bone.volume, {tick.X_VT_milled.position, tick.X_VT.position, longest_way_}, radius);
        if (deposit_.isOwing())
            result.include(deposit_.lay(bone, placeOf(tick), tick.milled_dt, tick.is_add_wanted));
    }

  private:
    ToolPlace placeOf(const EffectTick& tick) noexcept {
        if (tool_ != tick.tool->model) {
            tool_ = tick.tool->model;
            tool_radius_ = thickestNear(*tool_, tick.tool->burr.radius);
        }
        return {.p_VB = tick.X_VT.position,
                .axis_V = tick.X_VT.rotation * Eigen::Vector3d::UnitY(),
                .radius = tool_radius_,
                .way = std::min(longest_way_, (tick.X_VT.position - tick.X_VT_milled.position).norm())};
    }

    double longest_way_;  // m
    TimedMilling milling_;
    Deposit deposit_;
    const ToolModel* tool_ = nullptr;  // that is measured
    double tool_radius_ = 0;           // m
};

}  // namespace

std::unique_ptr<HapticEffect> AddMaterialConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<AddMaterial>(*this, needs.bone, needs.room);
}

}  // namespace bonemill
