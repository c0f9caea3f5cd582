// Returns the density's gradient at a voxel, wherever the voxels are kept. It is RT-safe.
#pragma once

#include <Eigen/Core>

namespace bonemill {

// Counts per m, V axes: central differences (thesis eq 1-3 over twice the distance), one-sided at the border
// of air. `voxel` in -1 .. dims; at(axis, step) is the density of the voxel `step` (-1, 0, 1) steps on.
template <class At>
Eigen::Vector3f densityGradient(const Eigen::Vector3i& voxel, const Eigen::Vector3i& dims,
                                const Eigen::Vector3f& inverse_spacing, At&& at) noexcept {
    Eigen::Vector3f gradient;
    if ((voxel.array() >= 0).all() && (voxel.array() < dims.array()).all()) {
        for (int axis = 0; axis < 3; ++axis)
            gradient[axis] = float(int(at(axis, 1)) - int(at(axis, -1))) * (inverse_spacing[axis] / 2);
        return gradient;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int low = voxel[axis] > -1 ? -1 : 0, high = voxel[axis] < dims[axis] ? 1 : 0;
        gradient[axis] =
            (float(at(axis, high)) - float(at(axis, low))) * inverse_spacing[axis] / float(high - low);
    }
    return gradient;
}

}  // namespace bonemill
