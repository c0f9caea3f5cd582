// Has a number of each voxel, mostly 0: of which zone it is, for example. Memory goes to bricks that hold
// another number. Reading is for any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/brick_map.h"

namespace bonemill {

class VoxelIds {
  public:
    // `ids` has one of each voxel, x fastest. It allocates.
    VoxelIds(const Eigen::Vector3i& dims, const std::vector<uint8_t>& ids);

    const Eigen::Vector3i& dims() const noexcept { return map_.dims(); }
    uint8_t at(const Eigen::Vector3i& voxel) const noexcept {
        const size_t place = map_.find(voxel);
        return place == BrickMap::kNowhere ? uint8_t(0) : ids_[place];
    }

  private:
    BrickMap map_;
    std::vector<uint8_t> ids_;
};

}  // namespace bonemill
