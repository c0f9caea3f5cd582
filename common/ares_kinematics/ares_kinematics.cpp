#include "common/ares_kinematics/ares_kinematics.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace bonemill {
namespace {

constexpr int kDirections = 64, kAxes = 48;
constexpr int kHalvings = 9;  // to 1 / 512 of what is searched

// Spreads directions evenly over the sphere, along a spiral with the golden angle.
Eigen::Vector3d direction(int i, int count) {
    const double z = 1 - (2.0 * i + 1) / count;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

bool isUsable(const AresKinematics& kinematics, const Pose& X_DT) {
    Matrix6d J_inv;
    return kinematics.workspaceFaults(X_DT) == kWorkspaceOk && kinematics.inverseJacobian(X_DT, J_inv) &&
           kinematics.isOwnAssembly(J_inv) && singularityIndex(J_inv) >= kMinSingularityIndex;
}

bool isUsableTurned(const AresKinematics& kinematics, const Eigen::Vector3d& p_DT, double turn) {
    if (!isUsable(kinematics, {p_DT, Eigen::Quaterniond::Identity()})) return false;
    for (int i = 0; turn > 0 && i < kAxes; ++i) {
        if (!isUsable(kinematics, {p_DT, expRotation(turn * direction(i, kAxes))})) return false;
    }
    return true;
}

Matrix6d conditioned(const Matrix6d& J_inv) {
    Matrix6d A = J_inv;
    A.rightCols<3>() /= kConditioningLength;
    return A;
}

// A Newton step is cut to these, so that a far start cannot overshoot into a mirrored pose. Wider than any
// error inside the specified workspace: a start at the neutral pose keeps its quadratic convergence.
constexpr double kMaxForwardTranslation = 0.1;  // m
constexpr double kMaxForwardRotation = 1.0;     // rad

Eigen::Vector3d onCircle(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

}  // namespace

AresKinematics::AresKinematics(const AresGeometry& geometry) noexcept : geometry_(geometry) {
    for (int i = 0; i < kLegCount; ++i) {
        const int pair = i / 2;
        const double pair_angle = 2 * std::numbers::pi / 3 * pair;
        const double side = i % 2 == 0 ? -1.0 : 1.0;
        legs_[i].base = onCircle(geometry.base_radius, pair_angle + side * geometry.base_half_angle);
        legs_[i].platform =
            onCircle(geometry.platform_radius, pair_angle + side * geometry.platform_half_angle);
    }
    const double reach = (legs_[0].platform - legs_[0].base).norm();
    neutral_height_ =
        geometry.stroke / 2 + std::sqrt(geometry.link_length * geometry.link_length - reach * reach);
    for (Leg& leg : legs_) leg.base.z() = -neutral_height_;
    Matrix6d J_inv;
    if (!isBuildable() || !inverseJacobian(Pose{}, J_inv)) return;
    handedness_ = J_inv.determinant() < 0 ? -1.0 : 1.0;
}

bool AresKinematics::isBuildable() const noexcept {
    Matrix6d J_inv;
    return std::isfinite(neutral_height_) && workspaceFaults(Pose{}) == kWorkspaceOk &&
           inverseJacobian(Pose{}, J_inv) && singularityIndex(J_inv) >= kMinSingularityIndex;
}

bool AresKinematics::linkVector(const Leg& leg, const Pose& X_DT, Eigen::Vector3d& link,
                                double& q) const noexcept {
    const Eigen::Vector3d reach = X_DT * leg.platform - leg.base;
    const double height_squared =
        geometry_.link_length * geometry_.link_length - reach.head<2>().squaredNorm();
    if (!(height_squared >= 0)) return false;
    link = {reach.x(), reach.y(), std::sqrt(height_squared)};
    q = reach.z() - link.z();
    return true;
}

bool AresKinematics::inverse(const Pose& X_DT, Vector6d& q) const noexcept {
    Eigen::Vector3d link;
    for (int i = 0; i < kLegCount; ++i) {
        if (!linkVector(legs_[i], X_DT, link, q[i])) return false;
    }
    return true;
}

bool AresKinematics::inverseJacobian(const Pose& X_DT, Matrix6d& J_inv) const noexcept {
    Eigen::Vector3d link;
    double q = 0;
    for (int i = 0; i < kLegCount; ++i) {
        if (!linkVector(legs_[i], X_DT, link, q) || link.z() == 0) return false;
        const Eigen::Vector3d row = link / link.z();  // n / (n·a): the link's length cancels
        J_inv.block<1, 3>(i, 0) = row.transpose();
        J_inv.block<1, 3>(i, 3) = (X_DT.rotation * legs_[i].platform).cross(row).transpose();
    }
    return true;
}

ForwardSolution AresKinematics::forward(const Vector6d& q, const Pose& X_DT_start) const noexcept {
    ForwardSolution solution{X_DT_start};
    Vector6d q_now;
    Matrix6d J_inv;
    while (inverse(solution.X_DT, q_now)) {
        const Vector6d error = q - q_now;
        if (!error.allFinite()) return solution;
        solution.converged = error.cwiseAbs().maxCoeff() <= kForwardTolerance;
        if (solution.converged || solution.iterations == kMaxForwardIterations) return solution;
        if (!inverseJacobian(solution.X_DT, J_inv)) return solution;
        Vector6d step = J_inv.partialPivLu().solve(error);
        const double excess = std::max(step.head<3>().norm() / kMaxForwardTranslation,
                                       step.tail<3>().norm() / kMaxForwardRotation);
        if (!std::isfinite(excess)) return solution;
        if (excess > 1) step /= excess;
        solution.X_DT = solution.X_DT.incremented(step.head<3>(), step.tail<3>());
        ++solution.iterations;
    }
    return solution;
}

uint32_t AresKinematics::workspaceFaults(const Pose& X_DT, double slack) const noexcept {
    // |w| is the cosine of half the turn. Without the comparison's negation not-a-number would pass.
    if (!(std::abs(X_DT.rotation.w()) >= std::cos(kMaxTurn / 2))) return kWorkspaceTurn;
    uint32_t faults = kWorkspaceOk;
    Eigen::Vector3d link;
    double q = 0;
    for (const Leg& leg : legs_) {
        if (!linkVector(leg, X_DT, link, q)) return kWorkspaceUnreachable;
        if (q < -slack || q > geometry_.stroke + slack) faults |= kWorkspaceStroke;
        if (link.z() < kMinLinkCosine * geometry_.link_length - slack) faults |= kWorkspaceLean;
    }
    return faults;
}

bool AresKinematics::isOwnAssembly(const Matrix6d& J_inv) const noexcept {
    return J_inv.determinant() * handedness_ > 0;
}

bool AresKinematics::linkHeights(const Pose& X_DT, Vector6d& heights, Matrix6d& gradient) const noexcept {
    Eigen::Vector3d link;
    double q = 0;
    for (int i = 0; i < kLegCount; ++i) {
        if (!linkVector(legs_[i], X_DT, link, q) || link.z() == 0) return false;
        heights[i] = link.z();
        // The link's length is constant: a height falls by what the platform's point goes outwards.
        const Eigen::Vector3d inwards(-link.x() / link.z(), -link.y() / link.z(), 0);
        gradient.block<1, 3>(i, 0) = inwards.transpose();
        gradient.block<1, 3>(i, 3) = (X_DT.rotation * legs_[i].platform).cross(inwards).transpose();
    }
    return true;
}

bool AresKinematics::inverseJacobianGradient(const Pose& X_DT,
                                             std::array<Matrix6d, 6>& gradient) const noexcept {
    Eigen::Vector3d link;
    double q = 0;
    for (int i = 0; i < kLegCount; ++i) {
        if (!linkVector(legs_[i], X_DT, link, q) || link.z() == 0) return false;
        const Eigen::Vector3d arm = X_DT.rotation * legs_[i].platform;  // from T's origin to the joint, in D
        const Eigen::Vector3d row = link / link.z();
        for (int k = 0; k < 6; ++k) {
            const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k % 3);
            const Eigen::Vector3d arm_change =
                k < 3 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : axis.cross(arm);
            const Eigen::Vector3d joint_change = k < 3 ? axis : arm_change;
            Eigen::Vector3d link_change(joint_change.x(), joint_change.y(), 0);
            link_change.z() = -link.dot(link_change) / link.z();
            const Eigen::Vector3d row_change = (link_change - link_change.z() * row) / link.z();
            gradient[k].block<1, 3>(i, 0) = row_change.transpose();
            gradient[k].block<1, 3>(i, 3) = (arm_change.cross(row) + arm.cross(row_change)).transpose();
        }
    }
    return true;
}

Vector6d actuatorForces(const Matrix6d& J_inv, const Wrench& wrench) noexcept {
    return J_inv.transpose().partialPivLu().solve(stacked(wrench));
}

Wrench wrenchOf(const Matrix6d& J_inv, const Vector6d& actuator_forces) noexcept {
    const Vector6d w = J_inv.transpose() * actuator_forces;
    return {w.head<3>(), w.tail<3>()};
}

Location locate(const AresKinematics& kinematics, const Vector6d& q, const Pose& X_DT_start) noexcept {
    Location location;
    const ForwardSolution solution = kinematics.forward(q, X_DT_start);
    location.X_DT = solution.X_DT;
    location.is_found = solution.converged && kinematics.inverseJacobian(solution.X_DT, location.J_inv);
    if (!location.is_found) return location;
    location.singularity_index = singularityIndex(location.J_inv);
    location.faults = kinematics.workspaceFaults(location.X_DT, kWorkspaceSlack);
    if (!(location.singularity_index >= kMinSingularityIndex)) location.faults |= kWorkspaceSingular;
    if (!kinematics.isOwnAssembly(location.J_inv)) location.faults |= kWorkspaceMirrored;
    return location;
}

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

double reachRadius(const AresKinematics& kinematics, double turn) noexcept {
    double radius = kinematics.geometry().stroke / 2;
    for (int i = 0; i < kDirections; ++i) {
        const Eigen::Vector3d way = direction(i, kDirections);
        if (isUsableTurned(kinematics, radius * way, turn)) continue;
        double inside = 0, outside = radius;
        for (int k = 0; k < kHalvings; ++k) {
            const double middle = (inside + outside) / 2;
            (isUsableTurned(kinematics, middle * way, turn) ? inside : outside) = middle;
        }
        radius = inside;
    }
    return radius;
}

}  // namespace bonemill
