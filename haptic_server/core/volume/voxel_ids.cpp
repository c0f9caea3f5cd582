#include "haptic_server/core/volume/voxel_ids.h"

namespace bonemill {

VoxelIds::VoxelIds(const Eigen::Vector3i& dims, const std::vector<uint8_t>& ids) : map_(dims) {
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

}  // namespace bonemill
