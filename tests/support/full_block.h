// A block of bone that fills its grid.
#pragma once

#include "tests/support/test_bodies.h"

namespace bonemill::test {

inline VoxelVolume fullBlock(const Eigen::Vector3i& dims, const Eigen::Vector3d& spacing) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    geometry.spacing = spacing;
    VoxelVolume bone(geometry, kTestIso);
    bone.fill([&](int i, int j, int k) {
        const bool is_inside = i >= 0 && j >= 0 && k >= 0 && i < dims.x() && j < dims.y() && k < dims.z();
        return is_inside ? kMaxDensity : Density(0);
    });
    return bone;
}

}  // namespace bonemill::test
