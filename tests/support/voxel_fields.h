// Makes random and special density fields, and the few moves that mesh and volume tests share.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "haptic_server/surface/mesh/leaf_mesher.h"

namespace bonemill::test {

inline VolumeGeometry boxGeometry(const Eigen::Vector3i& dims,
                                  const Eigen::Vector3d& spacing = Eigen::Vector3d(0.0004, 0.0005, 0.0007)) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    geometry.spacing = spacing;
    return geometry;
}

inline IndexBox wholeBox(const VoxelVolume& volume) {
    return {Eigen::Vector3i::Zero(), volume.dims() - Eigen::Vector3i::Ones()};
}

template <class Visit>
void forEachVoxel(const IndexBox& box, Visit&& visit) {
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j)
            for (int i = box.min.x(); i <= box.max.x(); ++i) visit(i, j, k);
}

// The voxels are independent, so that every configuration of a cell turns up. Few values are distinct, so
// that many equal iso exactly.
inline void fillNoise(VoxelVolume& volume, std::mt19937& random) {
    std::uniform_int_distribution<int> offset(-3, 3);
    forEachVoxel(wholeBox(volume), [&](int i, int j, int k) {
        volume.set(i, j, k, Density(volume.iso() + 50 * offset(random)));
    });
}

// Fills in a sum of a few waves: smooth surfaces in all directions, cut by the volume's border.
inline void fillWaves(VoxelVolume& volume, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    struct Wave {
        Eigen::Vector3d k;
        double phase;
    };
    std::vector<Wave> waves;
    for (int n = 0; n < 5; ++n)
        waves.push_back(
            {0.6 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random)), 3 * uniform(random)});
    forEachVoxel(wholeBox(volume), [&](int i, int j, int k) {
        double sum = 0;
        for (const Wave& w : waves) sum += std::sin(w.k.dot(Eigen::Vector3d(i, j, k)) + w.phase);
        volume.set(i, j, k, Density(std::lround(32768 + 6000 * sum)));
    });
}

// Makes up to four materials in stripes, with none in some of them.
inline BoneProperties stripedProperties(const VoxelVolume& volume) {
    return {volume,
            [](const Eigen::Vector3i& v) { return MaterialId((v.x() / 5 + v.y() / 7 + v.z() / 3) % 5); }};
}

inline std::vector<NodeMesh> meshAll(const VoxelVolume& volume, const LeafLattice& lattice,
                                     const BoneProperties* properties = nullptr) {
    LeafMesher mesher(volume, lattice, MeshGrid::kMaxStepsPerCell, {properties});
    std::vector<NodeMesh> meshes;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        NodeMesh mesh = mesher.mesh(leaf).value();
        if (!mesh.isEmpty()) meshes.push_back(std::move(mesh));
    }
    return meshes;
}

// It does what the tick does around a change of voxels.
template <class Write>
void writeLikeTick(VoxelVolume& volume, LeafLattice& lattice, const IndexBox& box, Write&& density_of) {
    lattice.beginWrite(box);
    forEachVoxel(box, [&](int i, int j, int k) { volume.set(i, j, k, density_of(i, j, k)); });
    lattice.refreshRanges(volume, box);
    lattice.endWrite(box);
}

inline IndexBox randomBox(const VoxelVolume& volume, int largest, std::mt19937& random) {
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::uniform_int_distribution<int>(0, volume.dims()[axis] - 1)(random);
        const int size = std::uniform_int_distribution<int>(1, largest)(random);
        box.max[axis] = std::min(box.min[axis] + size, volume.dims()[axis]) - 1;
    }
    return box;
}

inline bool sameMesh(const NodeMesh& a, const NodeMesh& b) {
    return a.leaf == b.leaf && a.origin == b.origin && a.step == b.step && a.vertices == b.vertices &&
           a.indices == b.indices && a.materials == b.materials;
}

}  // namespace bonemill::test
