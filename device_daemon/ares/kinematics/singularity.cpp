#include "device_daemon/ares/kinematics/singularity.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

Matrix6d conditioned(const Matrix6d& J_inv) {
    Matrix6d A = J_inv;
    A.rightCols<3>() /= kConditioningLength;
    return A;
}

}  // namespace

double singularityIndex(const Matrix6d& J_inv) noexcept {
    const Matrix6d A = conditioned(J_inv);
    // The singular values are roots of the Gram matrix' eigenvalues.
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A.transpose() * A, Eigen::EigenvaluesOnly);
    const double smallest = std::max(0.0, solver.eigenvalues()[0]);
    const double index = std::sqrt(smallest / solver.eigenvalues()[5]);
    return std::isfinite(index) ? index : 0.0;
}

double smoothIndex(const Matrix6d& J_inv) noexcept {
    const Matrix6d A = conditioned(J_inv);
    const double index = 6 / (A.norm() * A.inverse().norm());
    return std::isfinite(index) ? index : 0.0;
}

double smoothIndexChange(const Matrix6d& J_inv, const Matrix6d& J_inv_change) noexcept {
    const Matrix6d A = conditioned(J_inv);
    const Matrix6d dA = conditioned(J_inv_change);
    const Matrix6d A_inv = A.inverse();
    const Matrix6d dA_inv = -A_inv * dA * A_inv;
    const double index = 6 / (A.norm() * A_inv.norm());
    return -index * (A.cwiseProduct(dA).sum() / A.squaredNorm() +
                     A_inv.cwiseProduct(dA_inv).sum() / A_inv.squaredNorm());
}

}  // namespace bonemill
