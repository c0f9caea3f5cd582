// Returns the density's gradient at a voxel, smoothed across each of its axes, for normals that are drawn.
//
// A scan's edge is hardly wider than a voxel: differences along an axis alone depend on where the surface
// lies between the voxels, which shows as rings on smooth bone. The mean over the rows beside an axis, with
// Scharr's weights 3, 10, 3 in both directions, has a third of that error
// (tests/unit/haptic_server/surface/mesh/smooth_gradient_test.cpp).
#pragma once

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Counts per m, V axes. `center` points at the density of `voxel` among voxels that lie `stride` apart; those
// within 1 of it are read as far as they are readable. The sums are integers: leaves that share the voxel get
// the same gradient, bit for bit.
inline Eigen::Vector3f smoothGradient(const Eigen::Vector3i& voxel, const IndexBox& readable,
                                      const Eigen::Vector3f& inverse_spacing, const Density* center,
                                      const size_t (&stride)[3]) noexcept {
    constexpr int kWeights[] = {3, 10, 3}, kWeight = 16;
    ptrdiff_t step[3][3];  // per axis: to the voxels before, at and after this one, at the border to itself
    for (int axis = 0; axis < 3; ++axis) {
        step[axis][0] = voxel[axis] > readable.min[axis] ? -ptrdiff_t(stride[axis]) : 0;
        step[axis][1] = 0;
        step[axis][2] = voxel[axis] < readable.max[axis] ? ptrdiff_t(stride[axis]) : 0;
    }
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        const ptrdiff_t(&across)[3] = step[(axis + 1) % 3], (&aside)[3] = step[(axis + 2) % 3];
        int32_t rise = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const Density* row = center + across[i] + aside[j];
                rise += kWeights[i] * kWeights[j] * (int(row[step[axis][2]]) - int(row[step[axis][0]]));
            }
        const int steps = (step[axis][0] != 0) + (step[axis][2] != 0);
        gradient[axis] = float(rise) * (inverse_spacing[axis] / float(kWeight * kWeight * steps));
    }
    return gradient;
}

}  // namespace bonemill
