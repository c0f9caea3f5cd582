#include "tests/support/eigenvalues.h"

#include <Eigen/Eigenvalues>

namespace bonemill::test {

Vector6d eigenvaluesOf(const Matrix6d& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Matrix6d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace bonemill::test
