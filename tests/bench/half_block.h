// Makes a block of bone that fills the lower half of a volume, and the ways over its face that the
// benchmarks take.
#pragma once

#include <vector>

#include "haptic_server/core/tick/tick_io.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill::bench {

// The volume has edge³ voxels. Bone is where z is below the middle, with a ramp of one voxel so that the face
// is smooth and flat.
VoxelVolume halfBlock(int edge, double spacing);

// Returns the middle of the face, in V.
Eigen::Vector3d middleOfFace(const VoxelVolume& volume);

struct WeaveConfig {
    double burr_radius = 1e-3;  // m
    double depth = 1e-3;        // m, commanded
    double speed = 5e-3;        // m/s along the face
    double clearance = 0.5e-3;  // m above the face at the start
    int ticks = 4000, approach_ticks = 500;
    double dt = 1e-3;
    bool mills = true;
};

// The upright tool goes straight down to `depth` below the face, then winds over it.
std::vector<DeviceInput> weave(const VoxelVolume& volume, const WeaveConfig& config);

}  // namespace bonemill::bench
