// How the drilled hole lies to the planned line: its axis is that of the voxels that were removed around the
// line, by their moments.
#pragma once

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/assessment/product/change_grid.h"

namespace bonemill {

// Adds the figures "plan.*"; none without a hole that is longer than wide.
void addPlanFigures(const ChangeGrid& changes, const PlannedLine& line, const SolidBone& bone,
                    Figures& figures);

}  // namespace bonemill
