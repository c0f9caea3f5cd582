// Figures as a report shows them. Pure; any thread may call them. What is not known is a dash.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

inline std::string fixedText(double value, int digits) {
    if (std::isnan(value)) return "–";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

inline std::string pText(double p) {
    if (p < 0.0005) return "< .001";
    const std::string text = fixedText(p, 3);
    return text.starts_with("0.") ? text.substr(1) : text;
}

inline std::string intervalText(const Interval& interval, int digits) {
    if (std::isnan(interval.low) || std::isnan(interval.high)) return "–";
    return fixedText(interval.low, digits) + " to " + fixedText(interval.high, digits);
}

inline std::string percentText(double share) {
    return fixedText(100 * share, 0) + " %";
}

}  // namespace bonemill::study
