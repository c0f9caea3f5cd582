#include "haptic_server/core/volume/brick_map.h"

namespace bonemill {

BrickMap::BrickMap(const Eigen::Vector3i& dims)
    : dims_(dims), bricks_((dims.array() + kEdge - 1) / kEdge), slots_(size_t(bricks_.prod()), kNone) {}

IndexBox BrickMap::voxelsOf(const Eigen::Vector3i& brick) const noexcept {
    const Eigen::Vector3i low = brick * kEdge;
    return {low, (low.array() + kEdge - 1).min(dims_.array() - 1)};
}

}  // namespace bonemill
