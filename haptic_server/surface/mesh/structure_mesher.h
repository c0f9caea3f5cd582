// This makes the surface of a protected structure, for people to look at: smooth, although its voxels are
// cubes.
//
// Marching cubes over "is the voxel of this material" gives a surface of stairs half-way between voxels.
// Taubin's filter (1995) smooths it without shrinking it, and no vertex leaves the cell that it came from:
// the surface stays within half a voxel per axis of where the labels put it. Of labels that
// were drawn on coarser voxels it is their voxels that count: finer ones would show their stairs; what is
// thin moves less, or it would become a line. Then triangles are taken away while that moves the surface by
// less than a part of a voxel, and in any case down to kMaxStructureTriangles. At last the surface moves out
// evenly, by a quarter of a voxel at most, until it holds as much as the labels.
//
// It is not RT-safe (it allocates), but thread-safe.
#pragma once

#include <vector>

#include "common/geometry/node_mesh.h"
#include "common/geometry/pose.h"
#include "haptic_server/core/volume/bone_properties.h"

namespace bonemill {

inline constexpr size_t kMaxStructureTriangles = 24000;

// Returns one closed mesh (V, m) per protected material that some voxel has; its leaf is the MaterialId. What
// it says is that of the scanned bone, whatever is milled. `spacing` is that of the voxels, `label_edge` the
// shortest edge of those that the labels were drawn on, m; 0: the same. X_VP: the frame of these voxels in V.
std::vector<NodeMesh> meshStructures(const BoneProperties& properties, const MaterialTable& materials,
                                     const Eigen::Vector3d& spacing, double label_edge = 0,
                                     const Pose& X_VP = {});

}  // namespace bonemill
