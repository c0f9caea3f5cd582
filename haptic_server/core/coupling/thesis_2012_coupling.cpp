#include "haptic_server/core/coupling/thesis_2012_coupling.h"

#include <Eigen/LU>

namespace bonemill {
namespace {

// Returns the rotation from the SPO to the device, with a scalar part >= 0.
Eigen::Quaterniond rotationError(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    Eigen::Quaterniond error = X_VT_device.rotation * X_VT.rotation.conjugate();
    if (error.w() < 0) error.coeffs() = -error.coeffs();
    return error;
}

// The equilibrium matrix mixes N/m with N·m/rad; measuring rotations in this length (m/rad) balances
// its rows.
constexpr double kRotationLength = 0.03;
// It is the smallest ratio of LU pivots that is taken for a regular matrix.
constexpr double kMinPivotRatio = 1e-12;
// This is the share of the largest element that a singular matrix gets on its (negative) diagonal.
constexpr double kRegularisation = 1e-6;

bool isRegular(const Eigen::PartialPivLU<Matrix6d>& lu) noexcept {
    const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() > kMinPivotRatio * pivots.maxCoeff();
}

bool limitNorm(Eigen::Ref<Eigen::Vector3d> v, double most) noexcept {
    const double norm = v.norm();
    if (norm <= most) return false;
    v *= most / norm;
    return true;
}

}  // namespace

Wrench couplingWrench(const CouplingConfig& config, const Pose& X_VT, const Pose& X_VT_device) noexcept {
    return {config.translation_stiffness * (X_VT_device.position - X_VT.position),
            config.rotation_stiffness * rotationError(X_VT, X_VT_device).vec()};
}

Matrix6d couplingDerivative(const CouplingConfig& config, const Pose& X_VT,
                            const Pose& X_VT_device) noexcept {
    const Eigen::Quaterniond error = rotationError(X_VT, X_VT_device);
    Matrix6d derivative = Matrix6d::Zero();
    derivative.topLeftCorner<3, 3>().diagonal().setConstant(-config.translation_stiffness);
    derivative.bottomRightCorner<3, 3>() =
        -0.5 * config.rotation_stiffness * (error.w() * Eigen::Matrix3d::Identity() + skew(error.vec()));
    return derivative;
}

EquilibriumStep solveEquilibrium(const CouplingConfig& config, const Wrench& wrench,
                                 const Matrix6d& derivative, double dt) noexcept {
    Vector6d scale;
    scale << 1, 1, 1, 1 / kRotationLength, 1 / kRotationLength, 1 / kRotationLength;
    Vector6d w;
    w << wrench.force, wrench.torque;
    EquilibriumStep result;
    Matrix6d scaled = scale.asDiagonal() * derivative * scale.asDiagonal();
    if (!scaled.allFinite() || !w.allFinite()) return result;
    Eigen::PartialPivLU<Matrix6d> lu(scaled);
    result.is_regular = isRegular(lu);
    if (!result.is_regular) {
        scaled.diagonal().array() -= kRegularisation * scaled.cwiseAbs().maxCoeff();
        lu.compute(scaled);
        if (!isRegular(lu)) return result;
    }
    const Vector6d negative_scaled_wrench = -scale.cwiseProduct(w);
    result.step = scale.cwiseProduct(lu.solve(negative_scaled_wrench));
    if (!result.step.allFinite()) return {};
    result.is_found = true;
    const bool translation_clamped = limitNorm(result.step.head<3>(), config.max_speed * dt);
    const bool rotation_clamped = limitNorm(result.step.tail<3>(), config.max_angular_speed * dt);
    result.is_clamped = translation_clamped || rotation_clamped;
    return result;
}

}  // namespace bonemill
