// Contact is as stiff as the material: each contact point's energy is scaled by the factor of the voxel just
// inside the bone. The factors do not change, so that contact stays the gradient of an energy.
#pragma once

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

class MaterialStiffness final : public HapticEffect {
  public:
    MaterialStiffness(std::shared_ptr<const BoneProperties> properties, const MaterialTable& materials,
                      const Eigen::Vector3d& spacing);
    double scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                 const ToolField& tool, const Pose& X_VT) noexcept override;

  private:
    std::shared_ptr<const BoneProperties> properties_;
    std::vector<float> factor_;  // by MaterialId
    Eigen::Vector3f spacing_;
};

}  // namespace bonemill
