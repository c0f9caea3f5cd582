// Computes the distance field of the protected structures of a scan: exact Euclidean distances between
// voxels' centres, by one pass of lower envelopes of parabolas per axis (Felzenszwalb and Huttenlocher 2012),
// less half a voxel in the direction of the way, so that 0 lies on the voxels' faces.
//
// It is for start-up only, and allocates at most some 300 MB at a time, or for a long reach what lies within
// it of a slab as thick.
#pragma once

#include <memory>

#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/distance_field.h"

namespace bonemill {

// The work goes on in slabs of N voxels, with what lies within reach of them.
inline constexpr int64_t kVoxelsAtOnce = 20 << 20;

// The field is null if no voxel is of a protected material. `reach` is in m and > 0. Throws UserError if it
// has more voxels than that: neither time nor memory would be bounded by the scan's.
std::unique_ptr<DistanceField> protectedDistance(const BoneProperties& properties,
                                                 const MaterialTable& materials,
                                                 const Eigen::Vector3d& spacing, double reach,
                                                 int64_t voxels_at_once = kVoxelsAtOnce);

}  // namespace bonemill
