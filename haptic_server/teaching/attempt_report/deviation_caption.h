// What stands below the picture of over- and under-cut. Pure.
#pragma once

#include <string>

#include "common/base/units.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {

// `scale` in m: from there on colours are full.
inline std::string deviationCaption(double scale) {
    return "Red: cut too far. Blue: not far enough. Full colour from " +
           valueText(scale * kPerMillimetre, "mm") + " on.";
}

}  // namespace bonemill
