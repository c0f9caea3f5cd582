#include "haptic_server/scans/find_bone/bone_box.h"

namespace bonemill {

IndexBox boneBox(const VoxelVolume& volume) {
    IndexBox box;
    volume.forEachOwnedPart({Eigen::Vector3i::Zero(), volume.dims().array() - 1},
                            [&](const IndexBox& part, size_t) {
                                if (volume.uniformDensity(part.min) == 0) return;
                                forEachIndex(part, [&](const Eigen::Vector3i& v) {
                                    if (volume.at(v.x(), v.y(), v.z()) >= volume.iso()) box.include(v);
                                });
                            });
    return box;
}

Eigen::AlignedBox3d placesOf(const IndexBox& voxels, const Eigen::Vector3d& spacing) {
    if (voxels.isEmpty()) return {};
    return {spacing.cwiseProduct(voxels.min.cast<double>()), spacing.cwiseProduct(voxels.max.cast<double>())};
}

}  // namespace bonemill
