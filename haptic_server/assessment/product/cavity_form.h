// The form of what was hollowed out, seen along the way into the bone.
//
// With u out of the bone against that way and n a piece's normal: floor where n·u is above cos 45°, wall
// where it lies between, undercut below -sin 5°. The isthmus is the 5th percentile of the width from wall to
// wall, each measured along a wall's normal: the least width but for 5 % of the wall.
#pragma once

#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/cut_surface.h"

namespace bonemill {

// Adds the figures "cavity.*". `approach_V` goes into the bone and has length 1.
void addCavityFigures(const ChangeGrid& changes, const std::vector<CutPiece>& pieces,
                      const Eigen::Vector3d& approach_V, Figures& figures);

}  // namespace bonemill
