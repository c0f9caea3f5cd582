// The cubic B-spline through samples one apart, mirrored at both ends.
#pragma once

#include <array>
#include <span>

namespace bonemill {

// The coefficients depend on samples farther away by less than 1e-6 of their value.
inline constexpr int kSplineReach = 12;

// Samples become the spline's coefficients, in place.
void toSplineCoefficients(std::span<double> line) noexcept;

// The coefficients first .. first + 3 make the value at `at`, by these weights.
struct SplineWeights {
    std::array<int, 4> index;  // mirrored into 0 .. count - 1
    std::array<float, 4> weight;
};
SplineWeights splineWeightsAt(double at, int count) noexcept;

}  // namespace bonemill
