// Makes test bodies whose surface is known exactly, and their densities on any grid; and blocks of layers of
// known density: uniform, cortical shell over trabecular core, or whatever else.
//
// W is the world (and the written file's LPS frame); B is the body's own frame. Lengths are in m, angles in
// rad. In B (definitions are repeated in docs/reference/phantoms.md):
//   slab       |z| <= thickness / 2, endless in x and y
//   sphere     |p| <= radius
//   hole       plate |z| <= thickness / 2 with a round hole x² + y² < radius²
//   wedge      edge along y through the origin, solid towards -z, full opening angle `angle`
//   thin-wall  |x| <= thickness / 2 and z <= 0: a wall with a free upper edge
// Thread-safe; signedDistance does not allocate.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

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

// The values are 0 .. full, with the iso-surface at full / 2, rounded to whole numbers as an integer file
// stores them: the voxels of slice k. The density falls across the surface as surface_ramp.h says.
std::vector<float> sampleBodySlice(const AnalyticBody& body, const VolumeGeometry& geometry, double full,
                                   int k);

// Makes a grid along the axes of W whose middle is the origin of W.
VolumeGeometry centredGrid(const Eigen::Vector3i& dims, double voxel_size);

struct BlockLayer {
    double thickness;  // the last one's is what is left
    double hu;
};

// In W it fills |x| <= size.x/2, |y| <= size.y/2 and -size.z <= z <= 0: its top face is z = 0. Start-up only.
struct BlockPhantom {
    Eigen::Vector3d size{20e-3, 20e-3, 10e-3};
    std::vector<BlockLayer> layers{{0, 1500}};  // from the surface inwards; at least one
    bool is_shell = false;                      // layers follow all faces; else the top one
    double air_hu = -1000;
    double voxel = 0.125e-3;
    double margin = 1e-3;  // air around the block

    // The grid lies around the block and its margin, in step with the block's middle axis.
    VolumeGeometry grid() const;
    // It is linear from air_hu to the first layer over a voxel on both sides of each face, so that the
    // iso-surface half-way is the face exactly, between layers too.
    double hu(const Eigen::Vector3d& p_W) const noexcept;
    // It is the layer of the point, from 1, and 0 outside.
    uint8_t label(const Eigen::Vector3d& p_W) const noexcept;

  private:
    double signedDistance(const Eigen::Vector3d& p_W) const noexcept;
    double depth(const Eigen::Vector3d& p_W) const noexcept;
};

}  // namespace bonemill
