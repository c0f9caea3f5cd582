#include "haptic_server/volume/voxel_volume.h"

#include <algorithm>

namespace bonemill {

VoxelVolume::VoxelVolume(const VolumeGeometry& geometry, Density iso)
    : geometry_(geometry),
      iso_(iso),
      stride_y_(size_t(geometry.dims.x()) + 2),
      stride_z_(stride_y_ * (size_t(geometry.dims.y()) + 2)),
      inverse_spacing_(geometry.spacing.cwiseInverse().cast<float>()),
      density_(stride_z_ * (size_t(geometry.dims.z()) + 2) + kRowSlack, 0) {}

Eigen::Vector3f VoxelVolume::gradient(int i, int j, int k) const noexcept {
    const size_t here = offset(i, j, k);
    const size_t strides[3] = {1, stride_y_, stride_z_};
    const int index[3] = {i, j, k};
    Eigen::Vector3f g;
    const Eigen::Vector3i& last = geometry_.dims;
    const bool is_within = (unsigned(i) < unsigned(last.x())) & (unsigned(j) < unsigned(last.y())) &
                           (unsigned(k) < unsigned(last.z()));
    if (is_within) {
        for (int axis = 0; axis < 3; ++axis)
            g[axis] = float(int(at(here + strides[axis])) - int(at(here - strides[axis]))) *
                      (inverse_spacing_[axis] / 2);
        return g;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const size_t low = index[axis] > -1 ? here - strides[axis] : here;
        const size_t high = index[axis] < geometry_.dims[axis] ? here + strides[axis] : here;
        const float steps = high - low == strides[axis] ? 1.0f : 2.0f;
        g[axis] = (float(at(high)) - float(at(low))) * inverse_spacing_[axis] / steps;
    }
    return g;
}

}  // namespace bonemill
