// Turns figures into a judgement, by a task's gates and scales: gates first, then sub-scores, and a total
// only where the teacher gave weights.
#pragma once

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judged_task.h"

namespace bonemill {

// A gate on a figure that was not measured is not passed. A sub-score on one is left out; its weight then
// counts with a score of 0, so that what was not done gains nothing.
Assessment judge(const JudgedTask& task, Figures figures);

}  // namespace bonemill
