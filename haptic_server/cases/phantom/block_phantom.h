// Makes a block of layers of known density: uniform, cortical shell over trabecular core, or whatever else.
// It is for start-up only, and thread-safe.
//
// Lengths are in m. In W the block fills |x| <= size.x/2, |y| <= size.y/2 and -size.z <= z <= 0, so that its
// top face is z = 0.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

struct BlockLayer {
    double thickness;  // the last one's is what is left
    double hu;
};

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
