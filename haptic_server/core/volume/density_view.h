// Shows the kernels a volume's densities. RT-safe; for the owner of the volume only (tick thread).
#pragma once

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// The points' coordinates count from `origin`, V, m.
inline DensityView densityView(const VoxelVolume& volume,
                               const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) noexcept {
    const BrickStore& bricks = volume.bricks();
    DensityView view{.bricks = bricks.data(),
                     .slots = bricks.slots(),
                     .bricks_x = bricks.bricksPerAxis().x(),
                     .bricks_y = bricks.bricksPerAxis().y(),
                     .dims = {volume.dims().x(), volume.dims().y(), volume.dims().z()},
                     .iso = volume.iso(),
                     .inverse_spacing = {},
                     .origin = {}};
    for (int axis = 0; axis < 3; ++axis) {
        view.inverse_spacing[axis] = float(1 / volume.spacing()[axis]);
        view.origin[axis] = float(origin[axis]);
    }
    return view;
}

}  // namespace bonemill
