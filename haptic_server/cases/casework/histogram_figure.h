// The scan's values as a histogram, with the iso-value that is used, the proposed one and the next best.
#pragma once

#include <string>

#include "haptic_server/cases/casework/case_plan.h"

namespace bonemill {

// A whole gnuplot script that writes histogram.png where it runs. Start-up only: it goes through all values.
std::string histogramScript(const RawVolume& scan, const CasePlan& plan);

}  // namespace bonemill
