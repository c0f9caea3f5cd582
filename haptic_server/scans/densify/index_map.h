// From the voxels of one grid to those of another.
#pragma once

#include <Eigen/Geometry>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Takes the voxel indices of `to` to those of `from`.
inline Eigen::Affine3d indexMap(const VolumeGeometry& to, const VolumeGeometry& from) {
    const Pose X = from.X_WV.inverse() * to.X_WV;
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() =
        from.spacing.cwiseInverse().asDiagonal() * X.rotation.toRotationMatrix() * to.spacing.asDiagonal();
    map.translation() = from.spacing.cwiseInverse().cwiseProduct(X.position);
    return map;
}

}  // namespace bonemill
