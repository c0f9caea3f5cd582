// These say which octree leaves a tool can reach. They are RT-safe.
#pragma once

#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// This is the box in V around a box in T.
inline Eigen::AlignedBox3d boxInV(const Eigen::AlignedBox3d& box_T, const Pose& X_VT) noexcept {
    const Eigen::Matrix3d spread = X_VT.rotation.toRotationMatrix().cwiseAbs();
    const Eigen::Vector3d center = X_VT * box_T.center();
    const Eigen::Vector3d half = spread * (box_T.sizes() / 2);
    return {center - half, center + half};
}

struct Sphere {
    Eigen::Vector3d center;
    double radius;
};

// The sphere lies around all cells of a leaf, in V.
inline Sphere sphereAround(const IndexBox& cells, const Eigen::Vector3d& spacing) noexcept {
    const Eigen::Vector3d low = cells.min.cast<double>().cwiseProduct(spacing);
    const Eigen::Vector3d high = (cells.max.array() + 1).matrix().cast<double>().cwiseProduct(spacing);
    return {(low + high) / 2, (high - low).norm() / 2};
}

}  // namespace bonemill
