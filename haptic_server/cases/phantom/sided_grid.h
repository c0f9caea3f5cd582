// The grid of a phantom that is a piece of a left or a right half of the body.
#pragma once

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Holds the left piece's block (mm, W) and a margin of air, with voxels of this edge (m); the right one is
// the mirror image in x.
inline VolumeGeometry sidedGrid(const Eigen::AlignedBox3d& block_mm, double voxel_size, bool is_right) {
    constexpr double kMargin = 1;
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin);
    const Eigen::AlignedBox3d box(block_mm.min() - margin, block_mm.max() + margin);
    VolumeGeometry geometry;
    geometry.dims = (box.sizes() * kMillimetre / voxel_size).array().ceil().cast<int>() + 1;
    geometry.spacing.setConstant(voxel_size);
    geometry.X_WV.position = box.min() * kMillimetre;
    // The mirror image begins where the left one ends.
    if (is_right)
        geometry.X_WV.position.x() = -(geometry.X_WV.position.x() + voxel_size * (geometry.dims.x() - 1));
    return geometry;
}

}  // namespace bonemill
