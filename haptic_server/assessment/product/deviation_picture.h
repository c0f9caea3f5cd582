// A picture of what was cut: the bone's surface as the hand saw it, along the way into the bone, with what
// was cut too far in red and what was not cut far enough in blue.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/assessment/product/deviation.h"

namespace bonemill {

struct DeviationPicture {
    std::string png;      // the file's bytes; empty without a surface
    double scale = 1e-3;  // m: from there on red and blue are full
};

// `context` is all of the surface around; `approach_V` of length 1 goes into the picture. `voxel` in m. The
// same input gives the same bytes (of one libpng).
DeviationPicture drawDeviation(const Deviation& deviation, const std::vector<CutPiece>& context,
                               const Eigen::Vector3d& approach_V, double voxel);

}  // namespace bonemill
