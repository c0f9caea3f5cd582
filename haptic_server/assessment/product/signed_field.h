// The signed distance to the surface of a set of voxels: exact between voxels' centres, half a voxel less so
// that 0 lies on their faces, trilinear between samples at the voxels. Positive inside the set.
//
// The frame is V, the unit m. It is read-only after construction, which allocates.
#pragma once

#include <functional>
#include <vector>

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

class SignedField {
  public:
    // Nothing is known outside of the box: what lies there is as near as the box's rim says.
    SignedField(const IndexBox& box, const Eigen::Vector3d& spacing,
                const std::function<bool(const Eigen::Vector3i&)>& is_inside);

    // Infinite where the box holds no surface.
    double at(const Eigen::Vector3d& p_V) const noexcept;
    const IndexBox& box() const noexcept { return box_; }

  private:
    double sample(const Eigen::Vector3i& voxel) const noexcept;

    IndexBox box_;
    Eigen::Vector3i size_;
    Eigen::Vector3d spacing_;
    std::vector<float> distance_;
};

}  // namespace bonemill
