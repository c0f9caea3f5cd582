// The distance field of the protected structures of a scan. Exact Euclidean distances between voxels'
// centres, by one pass of lower envelopes of parabolas per axis (Felzenszwalb and Huttenlocher 2012), less
// half a voxel in the direction of the way, so that 0 lies on the voxels' faces.
//
// Start-up only; allocates at most some 300 MB at a time.
#pragma once

#include <memory>

#include "haptic_server/volume/bone_properties.h"
#include "haptic_server/volume/distance_field.h"

namespace bonemill {

// Null: no voxel is of a protected material. reach in m, > 0.
std::unique_ptr<DistanceField> protectedDistance(const BoneProperties& properties,
                                                 const MaterialTable& materials,
                                                 const Eigen::Vector3d& spacing, double reach);

}  // namespace bonemill
