// What a mesher's vertices show instead of their material.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// The mesher's thread calls all members; none throws.
class VertexPaint {
  public:
    virtual ~VertexPaint() = default;

    // The number that a vertex between these voxels gets in NodeMesh::materials; 0: it shows its material.
    // The edge alone decides, so that leaves agree.
    virtual uint8_t between(const Eigen::Vector3i& bone, const Eigen::Vector3i& air) const noexcept = 0;
    // Can vertices between these voxels show anything of it?
    virtual bool mayPaint(const IndexBox& voxels) const noexcept = 0;
    // Changes whenever the paint of a leaf's vertices does, though the bone does not; odd meanwhile.
    virtual uint32_t version(LeafId) const noexcept { return 0; }
};

}  // namespace bonemill
