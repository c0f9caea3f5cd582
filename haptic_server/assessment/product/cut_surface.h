// The pieces of the bone's surface around what is gone, or should be: the triangles of marching cubes, as
// they are drawn. The frame is V, the unit m.
#pragma once

#include <vector>

#include "haptic_server/assessment/product/change_grid.h"

namespace bonemill {

struct CutPiece {
    Eigen::Vector3d center_V, normal_V;  // out of the bone
    double area;                         // m²
    bool is_judged;                      // something around it is removed, or should be
};

// All of the surface in the box. `now` may not be written meanwhile. It allocates.
std::vector<CutPiece> surfaceIn(const VoxelVolume& now, const ChangeGrid& changes);

}  // namespace bonemill
