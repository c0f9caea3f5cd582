// Here are two measures of how well the legs hold the platform: 1 alike in every direction, 0 not at all in
// one.
//
// Both are of A = J_inv diag(I, I / kConditioningLength), which makes a turn and a shift comparable. They are
// RT-safe and pure.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

inline constexpr double kConditioningLength = 0.030;  // m

// A pose below this index is refused: rounding, encoder steps and forces grow too much there, and a little
// further on another assembly of the same legs begins. The specified workspace keeps above 0.22.
inline constexpr double kMinSingularityIndex = 0.1;
// A pose below this is so near the singularity that the platform may have gone through it.
inline constexpr double kLostSingularityIndex = 0.02;

// Returns sigma_min / sigma_max of A, exact above 1e-7; 0 is singular.
double singularityIndex(const Matrix6d& J_inv) noexcept;

// Returns 6 / (|A| |A^-1|) in the Frobenius norm: the same at 0 and 1, between the index and six times the
// index elsewhere, and smooth, which the index is not where singular values meet. 0 if J_inv is singular.
double smoothIndex(const Matrix6d& J_inv) noexcept;

// Returns the change of smoothIndex() when J_inv changes by J_inv_change, per unit of it.
double smoothIndexChange(const Matrix6d& J_inv, const Matrix6d& J_inv_change) noexcept;

}  // namespace bonemill
