// How far the surface that was made lies from the ideal one, in figures and as a picture: over-cut where it
// lies in bone that should have stayed, under-cut where it lies in what should be gone. The frame is V, the
// unit m.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/cut_surface.h"

namespace bonemill {

struct Deviation {
    std::vector<CutPiece> pieces;  // of the surface as it is now
    std::vector<double> distance;  // of each piece, m: positive is over-cut
};

// Of all pieces those that are judged; without an ideal surface in reach there is none.
Deviation deviationOf(const ChangeGrid& changes, const std::vector<CutPiece>& pieces);

// Adds the figures "overcut.*" and "undercut.*": mean, SD and 95th percentile by area, and maximum.
void addDeviationFigures(const Deviation& deviation, Figures& figures);

// A picture of what was cut: the bone's surface as the hand saw it, along the way into the bone, with what
// was cut too far in red and what was not cut far enough in blue.
struct DeviationPicture {
    std::string png;      // the file's bytes; empty without a surface
    double scale = 1e-3;  // m: from there on red and blue are full
};

// `context` is all of the surface around; `approach_V` of length 1 goes into the picture. `voxel` in m. The
// same input gives the same bytes (of one libpng).
DeviationPicture drawDeviation(const Deviation& deviation, const std::vector<CutPiece>& context,
                               const Eigen::Vector3d& approach_V, double voxel);

}  // namespace bonemill
