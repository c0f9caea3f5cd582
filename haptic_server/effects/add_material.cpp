#include "haptic_server/effects/add_material.h"

namespace bonemill {

AddMaterial::AddMaterial(const AddMaterialConfig& config, const BoneModel& bone, double largest_burr_radius,
                         size_t most_cells)
    : HapticEffect(0),
      milling_({.removal_rate = 0, .addition_rate = config.rate, .most_cells = most_cells}, bone.volume,
               bone.lattice, largest_burr_radius) {}

void AddMaterial::mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept {
    if (!tick.is_add_wanted) return;
    milling_.setShape(tick.shape);
    milling_.setBurrRadius(tick.tool->burr.radius);
    result.include(milling_.apply(bone.volume, bone.lattice, bone.shell, tick.X_VT.position, +1, tick.dt));
}

}  // namespace bonemill
