// How near the places of a patch come to the tool at least. RT-safe.
#pragma once

#include <cmath>

#include "haptic_server/contact/shell_pool.h"
#include "haptic_server/tool/tool_field.h"

namespace bonemill {

// A place of a patch is nearer than the patch's point by what lies in the patch's plane of the way to the
// tool, and by what the bone bends towards it: as much as the thinnest tool does.
class PatchReach {
  public:
    // reach_per_area: half a patch's diagonal, squared, per area.
    PatchReach(const Pose& X_VT, const ToolField& tool, float reach_per_area) noexcept
        : R_VT_(X_VT.rotation.toRotationMatrix().cast<float>()),
          reach_per_area_(reach_per_area),
          beside_(reach_per_area > 0 ? float(0.5 / tool.thinnestRadius()) : 0) {}

    // Of the block's first `count` points, whose distances and gradients (T) are `at`.
    void nearestPlaces(const ShellBlock& block, int count, const SampleBatch<float>& at,
                       float* nearest) const noexcept {
        const Eigen::Matrix3f& R = R_VT_;
        for (int i = 0; i < count; ++i) {
            const float gx = R(0, 0) * at.gx[i] + R(0, 1) * at.gy[i] + R(0, 2) * at.gz[i];
            const float gy = R(1, 0) * at.gx[i] + R(1, 1) * at.gy[i] + R(1, 2) * at.gz[i];
            const float gz = R(2, 0) * at.gx[i] + R(2, 1) * at.gy[i] + R(2, 2) * at.gz[i];
            const float cx = gy * block.nz[i] - gz * block.ny[i], cy = gz * block.nx[i] - gx * block.nz[i],
                        cz = gx * block.ny[i] - gy * block.nx[i];
            const float in_plane_squared = cx * cx + cy * cy + cz * cz;
            nearest[i] = at.distance[i] - std::sqrt(in_plane_squared * reach_per_area_ * block.area[i]) -
                         beside_ * block.area[i];
        }
    }

  private:
    Eigen::Matrix3f R_VT_;
    float reach_per_area_, beside_;
};

}  // namespace bonemill
