// Where the voxels of a leaf are in its copy (LeafCopy). RT-safe, for any thread.
#pragma once

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

inline IndexBox voxelsOf(const IndexBox& cells) noexcept {
    return {cells.min, cells.max.array() + 1};
}

// A voxel has this place in the copy of the leaf with these cells.
inline size_t placeOf(const IndexBox& cells, const Eigen::Vector3i& voxel) noexcept {
    const Eigen::Vector3i n = cells.max - cells.min + Eigen::Vector3i::Constant(2), at = voxel - cells.min;
    return size_t(at.x()) + size_t(n.x()) * (size_t(at.y()) + size_t(n.y()) * size_t(at.z()));
}

// Calls visit(first voxel) for each row along x of the box.
template <class Visit>
void forEachRow(const IndexBox& voxels, Visit&& visit) noexcept {
    forEachIndex({voxels.min, {voxels.min.x(), voxels.max.y(), voxels.max.z()}}, visit);
}

}  // namespace bonemill
