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
    VoxelIds(const Eigen::Vector3i& dims, const std::vector<uint8_t>& ids) : map_(dims) {
        std::vector<uint8_t> brick_ids(BrickMap::kBrick);
        forEachIndex({Eigen::Vector3i::Zero(), map_.bricksPerAxis().array() - 1},
                     [&](const Eigen::Vector3i& brick) {
                         bool is_something = false;
                         std::fill(brick_ids.begin(), brick_ids.end(), uint8_t(0));
                         forEachIndex(map_.voxelsOf(brick), [&](const Eigen::Vector3i& v) {
                             const size_t row = size_t(v.y()) + size_t(dims.y()) * size_t(v.z());
                             const uint8_t id = ids[size_t(v.x()) + size_t(dims.x()) * row];
                             brick_ids[BrickMap::inBrick(v)] = id;
                             is_something |= id != uint8_t(0);
                         });
                         if (!is_something) return;
                         map_.addBrick(brick);
                         ids_.insert(ids_.end(), brick_ids.begin(), brick_ids.end());
                     });
    }

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
