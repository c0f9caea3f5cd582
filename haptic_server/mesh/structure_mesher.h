// This makes the surface of a protected structure, for people to look at: smooth, although its voxels are
// cubes.
//
// Marching cubes over "is the voxel of this material" gives a surface of stairs half-way between voxels.
// Taubin's filter (1995) smooths it without shrinking it, and no vertex leaves the cell that it came from:
// the surface stays within half a voxel per axis of where the labels put it. Then triangles are taken away
// while that moves the surface by less than a part of a voxel, and in any case down to
// kMostStructureTriangles.
//
// It is not RT-safe (it allocates), but thread-safe.
#pragma once

#include <vector>

#include "common/geometry/node_mesh.h"
#include "haptic_server/volume/bone_properties.h"

namespace bonemill {

inline constexpr size_t kMostStructureTriangles = 24000;

// Returns one closed mesh (V, m) per protected material that some voxel has; its leaf is the MaterialId. What
// it says is that of the scanned bone, whatever is milled.
std::vector<NodeMesh> meshStructures(const BoneProperties& properties, const MaterialTable& materials,
                                     const Eigen::Vector3d& spacing);

}  // namespace bonemill
