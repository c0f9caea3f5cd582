#include "haptic_server/contact/shell_point.h"

namespace bonemill {
namespace {

struct CrossingSum {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // voxel steps from the block's first voxel
    int count = 0;
};

// Adds the crossings on all edges along `axis` between the voxels of the block.
void addCrossings(const VoxelVolume& volume, const IndexBox& cells, int axis,
                  CrossingSum& crossings) noexcept {
    const size_t strides[3] = {1, volume.strideY(), volume.strideZ()};
    const Density iso = volume.iso();
    Eigen::Vector3i last = cells.max.array() + 1;
    last[axis] -= 1;
    for (int k = cells.min.z(); k <= last.z(); ++k)
        for (int j = cells.min.y(); j <= last.y(); ++j) {
            size_t here = volume.offset(cells.min.x(), j, k);
            for (int i = cells.min.x(); i <= last.x(); ++i, ++here) {
                const Density low = volume.at(here);
                const Density high = volume.at(here + strides[axis]);
                if ((low >= iso) == (high >= iso)) continue;
                Eigen::Vector3f at(float(i - cells.min.x()), float(j - cells.min.y()),
                                   float(k - cells.min.z()));
                at[axis] += (float(iso) - float(low)) / (float(high) - float(low));
                crossings.sum += at;
                ++crossings.count;
            }
        }
}

Eigen::Vector3f interpolatedGradient(const VoxelVolume& volume, const IndexBox& cells,
                                     const Eigen::Vector3f& from_first) noexcept {
    const Eigen::Vector3i size = cells.max - cells.min + Eigen::Vector3i::Ones();
    const Eigen::Vector3f t = from_first.cwiseQuotient(size.cast<float>());
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const Eigen::Vector3i voxel = cells.min + bit.cwiseProduct(size);
        const float weight =
            (bit.x() ? t.x() : 1 - t.x()) * (bit.y() ? t.y() : 1 - t.y()) * (bit.z() ? t.z() : 1 - t.z());
        gradient += weight * volume.gradient(voxel.x(), voxel.y(), voxel.z());
    }
    return gradient;
}

}  // namespace

ShellPoint makeShellPoint(const VoxelVolume& volume, const IndexBox& cells) noexcept {
    CrossingSum crossings;
    for (int axis = 0; axis < 3; ++axis) addCrossings(volume, cells, axis, crossings);
    const Eigen::Vector3f from_first = crossings.sum / float(crossings.count);
    const Eigen::Vector3f gradient = interpolatedGradient(volume, cells, from_first);
    const float length = gradient.norm();
    ShellPoint point;
    point.position = (cells.min.cast<float>() + from_first).cwiseProduct(volume.spacing().cast<float>());
    point.normal = length > 0 ? Eigen::Vector3f(-gradient / length) : Eigen::Vector3f::Zero();
    point.key = 0;
    return point;
}

}  // namespace bonemill
