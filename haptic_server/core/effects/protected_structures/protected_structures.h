// Watches the burr near protected structures: how far it is, how hard the tool presses on them, how much of
// them was destroyed. Changes nothing.
//
// Damaged is a voxel of a protected material once a turning burr has covered its centre, or it has lost its
// bone. It counts once, until the scan is put back; to go back to a checkpoint undoes no damage.
#pragma once

#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/protected_structures/place_marks.h"

namespace bonemill {

class ProtectedStructures final : public HapticEffect {
  public:
    // Keeps a reference to the bone.
    ProtectedStructures(const ProtectedStructuresConfig& config, const EffectConfigs& all,
                        const BoneModel& bone);
    void restart(Restart why) noexcept override;
    void finish(EffectTick& tick) noexcept override;

  private:
    bool isProtected(MaterialId id) const noexcept { return is_protected_[id]; }
    struct Pressed {
        double force = 0;                  // N
        MaterialId hardest = kNoMaterial;  // under the contact of the largest force
    };
    struct Destroyed {
        size_t voxels = 0;
        MaterialId material = kNoMaterial;  // of the last one
    };
    Pressed pressedOn(const EffectTick& tick) const noexcept;
    Destroyed countDamage(const EffectTick& tick) noexcept;
    bool mayHaveProtected(const IndexBox& row) const noexcept;
    void damageInRow(const EffectTick& tick, const Pose& X_TV, const IndexBox& row,
                     Destroyed& destroyed) noexcept;
    bool isDestroyed(const EffectTick& tick, const Pose& X_TV, const Eigen::Vector3i& voxel,
                     size_t place) const noexcept;

    ProtectedStructuresConfig config_;
    std::shared_ptr<const BoneProperties> properties_;
    std::shared_ptr<const DistanceField> field_;
    const BoneModel& bone_;
    std::array<bool, kMaxMaterials + 1> is_protected_{};
    PlaceMarks is_damaged_;           // by place in properties_
    Eigen::Vector2i next_row_{0, 0};  // y, z: where the last tick's search ended
    size_t damaged_ = 0;              // voxels
    bool is_put_back_ = false;        // in this tick: the bone is on its way to the scan
};

}  // namespace bonemill
