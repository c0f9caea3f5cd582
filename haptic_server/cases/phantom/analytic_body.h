// Makes test bodies whose surface is known exactly, and their densities on any grid.
//
// W is the world (and the written file's LPS frame); B is the body's own frame. Lengths are in m, angles in
// rad. In B (definitions are repeated in docs/teach/volumes.md):
//   slab       |z| <= thickness / 2, endless in x and y
//   sphere     |p| <= radius
//   hole       plate |z| <= thickness / 2 with a round hole x² + y² < radius²
//   wedge      edge along y through the origin, solid towards -z, full opening angle `angle`
//   thin-wall  |x| <= thickness / 2 and z <= 0: a wall with a free upper edge
// Thread-safe; signedDistance does not allocate.
#pragma once

#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/core/volume/surface_ramp.h"

namespace bonemill {

enum class BodyKind { kSlab, kSphere, kHole, kWedge, kThinWall };

struct AnalyticBody {
    BodyKind kind = BodyKind::kSphere;
    double radius = 4e-3;
    double thickness = 4e-3;
    double angle = 0.7;  // 0 < angle < pi
    Pose X_WB;
};

// This is the exact distance from a point in W to the surface, negative inside the solid.
double signedDistance(const AnalyticBody& body, const Eigen::Vector3d& p_W) noexcept;

// The density falls across the surface as surface_ramp.h says.
double bodyDensity(const AnalyticBody& body, const VolumeGeometry& geometry, const Eigen::Vector3d& p_W,
                   double full) noexcept;

// The values are 0 .. full, with the iso-surface at full / 2, rounded to whole numbers as an integer file
// stores them: the voxels of slice k, and all slices.
std::vector<float> sampleBodySlice(const AnalyticBody& body, const VolumeGeometry& geometry, double full,
                                   int k);
RawVolume sampleBody(const AnalyticBody& body, const VolumeGeometry& geometry, double full);

// Makes a grid along the axes of W whose middle is the origin of W.
VolumeGeometry centredGrid(const Eigen::Vector3i& dims, double voxel_size);

}  // namespace bonemill
