// The page of a what-if: what happened beside what would have, on one sheet. Pure; any thread may call it.
#pragma once

#include <string>

#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {

// One of the two courses.
struct Course {
    Assessment assessment;
    double begin_s = 0, duration_s = 0;  // as of an attempt
};

struct WhatIfWords {
    std::string scene_title, trainee;  // empty: no attempt, the whole session
    std::string change;                // "the hand 0.5 mm along x"
    double at_s = 0;                   // of the session's clock
    std::string proof;                 // what both have in common, a sentence
    std::string replay;                // the command that shows both
};

// A page like an attempt's report (html_report.h).
std::string whatIfPage(const Course& happened, const Course& otherwise, const WhatIfWords& words);

// For a terminal: a line per gate and per figure that differs first, aligned.
std::string whatIfText(const Course& happened, const Course& otherwise);

}  // namespace bonemill
