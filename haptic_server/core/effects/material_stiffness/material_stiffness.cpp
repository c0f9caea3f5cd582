#include "haptic_server/core/effects/material_stiffness/material_stiffness.h"

#include <algorithm>

#include "haptic_server/core/effects/make_effects.h"
#include "haptic_server/core/effects/voxel_inside.h"

namespace bonemill {

MaterialStiffness::MaterialStiffness(std::shared_ptr<const BoneProperties> properties,
                                     const MaterialTable& materials, const Eigen::Vector3d& spacing)
    : HapticEffect(kScales), properties_(std::move(properties)), spacing_(spacing.cast<float>()) {
    for (const MaterialProperties& material : materials) factor_.push_back(float(material.stiffness_factor));
}

double MaterialStiffness::scale(const EffectTick&, Candidates& candidates, const Eigen::Vector3d& origin_V,
                                const ToolField&, const Pose&) noexcept {
    const Eigen::Vector3f origin = origin_V.cast<float>();
    float largest = 1;
    for (size_t n = 0; n < candidates.count; ++n) {
        const Eigen::Vector3i voxel =
            voxelInside(origin + candidates.position(n), candidates.normal(n), spacing_);
        const float factor = factor_[properties_->material(voxel)];
        candidates.weight[n] *= factor;
        largest = std::max(largest, factor);
    }
    return double(largest);
}

std::unique_ptr<HapticEffect> MaterialStiffnessConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<MaterialStiffness>(needs.all.properties, needs.all.materials,
                                               needs.bone.volume.spacing());
}

}  // namespace bonemill
