// Contact is as stiff as the material: each contact point's energy is scaled by the factor of the voxel just
// inside the bone. The factors do not change, so that contact stays the gradient of an energy.
#include <algorithm>

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/voxel_inside.h"

namespace bonemill {
namespace {

class MaterialStiffness final : public HapticEffect {
  public:
    MaterialStiffness(std::shared_ptr<const BoneProperties> properties, const MaterialTable& materials,
                      const Eigen::Vector3d& spacing)
        : HapticEffect(kScales), properties_(std::move(properties)), spacing_(spacing.cast<float>()) {
        for (const MaterialProperties& material : materials)
            factor_.push_back(float(material.stiffness_factor));
    }
    double scale(const EffectTick&, Candidates& candidates, const Eigen::Vector3d& origin_V, const ToolField&,
                 const Pose&) noexcept override {
        const Eigen::Vector3f origin = origin_V.cast<float>();
        float largest = 1;
        for (size_t first = 0; first < candidates.count; first += kBatch) {
            const size_t count = std::min(kBatch, candidates.count - first);
            int voxel[3][kBatch];
            const std::vector<float>* const places[3] = {&candidates.x, &candidates.y, &candidates.z};
            const std::vector<float>* const normals[3] = {&candidates.nx, &candidates.ny, &candidates.nz};
            for (int axis = 0; axis < 3; ++axis)
                for (size_t i = 0; i < count; ++i)
                    voxel[axis][i] = voxelInside(origin[axis] + (*places[axis])[first + i],
                                                 (*normals[axis])[first + i], spacing_[axis]);
            for (size_t i = 0; i < count; ++i) {
                const float factor = factor_[properties_->material({voxel[0][i], voxel[1][i], voxel[2][i]})];
                candidates.weight[first + i] *= factor;
                largest = std::max(largest, factor);
            }
        }
        return double(largest);
    }

  private:
    static constexpr size_t kBatch = 64;

    std::shared_ptr<const BoneProperties> properties_;
    std::vector<float> factor_;  // by MaterialId
    Eigen::Vector3f spacing_;
};

}  // namespace

std::unique_ptr<HapticEffect> MaterialStiffnessConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<MaterialStiffness>(needs.all.properties, needs.all.materials,
                                               needs.bone.volume.spacing());
}

}  // namespace bonemill
