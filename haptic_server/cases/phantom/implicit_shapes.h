// Puts the phantoms' shapes together: functions that are negative inside, in any one length unit.
#pragma once

#include <algorithm>
#include <cmath>

namespace bonemill {

inline double smoothStep(double low, double high, double x) noexcept {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Makes the smooth union of two implicit shapes with a fillet of about `fillet`.
inline double blend(double a, double b, double fillet) noexcept {
    const double h = std::max(fillet - std::abs(a - b), 0.0) / fillet;
    return std::min(a, b) - h * h * fillet / 4;
}

}  // namespace bonemill
