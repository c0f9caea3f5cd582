// How smooth a discrete movement is, from its speed at a fixed rate: S. Balasubramanian's measures, as his
// program computes them (github.com/siva82kb/SPARC, scripts/smoothness.py). The functions are pure and
// allocate; any thread may call them.
#pragma once

#include <span>

namespace bonemill {

// Spectral arc length: the nearer to 0 the smoother. NaN for a movement without speed. `rate` in Hz.
double sparc(std::span<const double> speed, double rate);
// Log dimensionless jerk: the larger the smoother. NaN for less than three samples, or without change of
// acceleration.
double logDimensionlessJerk(std::span<const double> speed, double rate);
// The frequency (Hz) below which 95 % of the power of the speed lies. NaN for a movement without speed.
double motionFrequency95(std::span<const double> speed, double rate);

}  // namespace bonemill
