// Joins the surface of the milled bone's surroundings, which has the scan's own voxels, to that of the milled
// bone, which has others.
//
// Around the region lies one layer of cells of the scan, bent so that their inner corners are voxels of the
// rim (region_rim.h). Outside they have the scan's edges, inside the many small ones of the rim. As in
// marching cubes (marching_cubes_table.h) the crossed edges of each face are joined by segments that the face
// alone decides, and the segments of a cell make loops, which are filled. So the surface has no holes,
// whatever the voxels are: its vertices on the rim are those of LeafMesher with that rim, and those outside
// are those of LeafMesher on the scan once these are
// on the RimGrid, normals included.
//
// It is not RT-safe (it allocates); for one thread at a time.
#pragma once

#include <array>
#include <optional>

#include "common/geometry/node_mesh.h"
#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/surface/mesh/rim_grid.h"
#include "haptic_server/surface/mesh/scan_shade.h"

namespace bonemill {

class SurroundingsJoint {
  public:
    // Both must outlive this object; without shades (null) vertices have no material.
    SurroundingsJoint(const Surroundings& surroundings, ScanShade* shade);

    // Cells of the scan in whose place are the region and the joint.
    const IndexBox& cells() const noexcept { return cells_; }

    const RimGrid& grid() const noexcept { return grid_; }

    // It is made in parts.
    uint32_t partCount() const noexcept { return uint32_t(parts_.prod()); }
    NodeMesh mesh(uint32_t part) const;  // V, m; leaf and revision are 0; may be empty

  private:
    friend class JointPart;

    struct Planes {
        std::vector<int> rim;     // per plane of the scan's voxels: that of the rim in its place
        std::vector<double> low;  // V, m: where the lower one of the two lies
    };

    const Surroundings& surroundings_;
    RimGrid grid_;
    ScanShade* shade_;
    IndexBox cells_;                // of the scan, S indices
    std::array<Planes, 3> planes_;  // per axis, from cells_.min on
    Eigen::Vector3i parts_;         // per axis
};

}  // namespace bonemill
