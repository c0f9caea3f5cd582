// How far the surface that was made lies from the ideal one: over-cut where it lies in bone that should have
// stayed, under-cut where it lies in what should be gone. The frame is V, the unit m.
#pragma once

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

}  // namespace bonemill
