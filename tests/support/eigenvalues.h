#pragma once

#include "common/geometry/pose.h"

namespace bonemill::test {

// Of a symmetric matrix, ascending. Apart, because the compiler takes seconds for Eigen's solver.
Vector6d eigenvaluesOf(const Matrix6d& symmetric);

}  // namespace bonemill::test
