// A small bone with the densities of a scan, for tests of how they are streamed: noise in whole HU, air in
// one corner, an odd number of voxels. It is milled without a tick, by whoever calls.
#pragma once

#include <random>

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/core/volume/bone_properties.h"
#include "tests/support/ct_brick.h"

namespace bonemill::test {

inline VoxelVolume scannedVolume(uint32_t seed) {
    VolumeGeometry geometry;
    geometry.dims = {53, 41, 37};
    geometry.spacing = Eigen::Vector3d(0.4e-3, 0.4e-3, 0.5e-3);
    VoxelVolume volume(geometry, 20000);
    std::mt19937 random(seed);
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        if ((v.array() < 18).all()) return;
        const double hu = double(random() % 200) + 20.0 * v.x();
        volume.set(v.x(), v.y(), v.z(), Density(std::lround(hu / kCtWindow * kMaxDensity)));
    });
    volume.shareUniformBricks();
    return volume;
}

struct ScannedBone {
    BoneModel bone{scannedVolume(5), Eigen::Vector3i::Constant(16), ShellConfig{}};
    BoneHistory history{bone};

    Density at(const Eigen::Vector3i& v) const { return bone.volume.at(v.x(), v.y(), v.z()); }
    Density scannedAt(const Eigen::Vector3i& v) const { return history.scanned().at(v.x(), v.y(), v.z()); }
    // As the tick does: it belongs to one thread.
    void write(const IndexBox& voxels, Density density) {
        const auto n = size_t(voxels.max.x() - voxels.min.x() + 1);
        const std::vector<Density> row(n, density);
        bone.lattice.beginWrite(voxels);
        bone.volume.openBricksIn(voxels);
        forEachIndex({voxels.min, {voxels.min.x(), voxels.max.y(), voxels.max.z()}},
                     [&](const Eigen::Vector3i& first) { bone.volume.writeRow(first, int(n), row.data()); });
        bone.lattice.endWrite(voxels);
    }
};

// The materials are 0 to 3, without any order.
inline BoneProperties randomMaterials(const ScannedBone& scan) {
    std::mt19937 random(8);
    return BoneProperties(scan.history.scanned(),
                          [&](const Eigen::Vector3i&) { return MaterialId(random() % 4); });
}

inline Eigen::Vector3i randomVoxel(const VoxelVolume& volume, std::mt19937& random) {
    const Eigen::Vector3i& n = volume.dims();
    return {int(random() % uint32_t(n.x())), int(random() % uint32_t(n.y())),
            int(random() % uint32_t(n.z()))};
}

}  // namespace bonemill::test
