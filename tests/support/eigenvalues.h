#pragma once

#include "common/geometry/pose.h"

namespace bonemill::test {

// Gives the eigenvalues of a symmetric matrix, ascending. They are apart because the compiler takes seconds
// for Eigen's solver.
Vector6d eigenvaluesOf(const Matrix6d& symmetric);

}  // namespace bonemill::test
