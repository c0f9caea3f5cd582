#include "haptic_server/core/coupling/energy_coupling.h"

#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSmallest = 1e-12;  // m or rad: below it the spring is linear in any direction
constexpr double kStiffnessFloor =
    0.02;  // of k, in the matrix only: a saturated spring keeps the solve regular

// It is a tanh spring over the length s of a vector.
struct Spring {
    double energy, pull, slope, secant;  // slope: d pull / ds; secant: pull / s
};

Spring springAt(double k, double most, double s) noexcept {
    const double t = k * s / most;
    const double below = -pinned::expm1(-2 * t), e = 1 - below;  // e^(-2t)
    const double tanh = below / (1 + e), sech_squared = 4 * e / ((1 + e) * (1 + e));
    const double log_cosh = t + pinned::log1p(e) - M_LN2;
    const double pull = most * tanh;
    return {most * most / k * log_cosh, pull, k * sech_squared, s > kSmallest ? pull / s : k};
}

// Returns along uuᵀ + across (I - uuᵀ), neither below the floor.
Matrix3d directional(const Vector3d& vector, double along, double across, double k) noexcept {
    const double floor = kStiffnessFloor * k;
    const double norm = vector.norm();
    const double a = std::max(along, floor), b = std::max(across, floor);
    if (norm <= kSmallest) return a * Matrix3d::Identity();
    const Vector3d u = vector / norm;
    return b * Matrix3d::Identity() + (a - b) * u * u.transpose();
}

// Returns (θ/2) cot(θ/2), which says how a turn across the rotation vector changes it.
double halfCotangent(double theta) noexcept {
    const double half = theta / 2;
    if (half < 1e-4) return 1 - half * half / 3;
    return half * pinned::cos(half) / pinned::sin(half);
}

Vector3d springVector(const Vector3d& stretch, const Spring& spring) noexcept {
    return spring.secant * stretch;
}

// Adds a spring force on the tool at r from its tool point, with stiffness K there.
void addSpring(EnergyTerm& term, const Vector3d& r, const Vector3d& force, double energy,
               const Matrix3d& K) noexcept {
    const Matrix3d r_skew = skew(r);
    term.energy += energy;
    term.wrench.force += force;
    term.wrench.torque += r.cross(force);
    term.stiffness.topLeftCorner<3, 3>() += K;
    term.stiffness.topRightCorner<3, 3>() -= K * r_skew;
    term.stiffness.bottomLeftCorner<3, 3>() += r_skew * K;
    term.stiffness.bottomRightCorner<3, 3>() -= r_skew * K * r_skew;
}

Eigen::Quaterniond fromSpoToDevice(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    return X_VT_device.rotation * X_VT.rotation.conjugate();
}

}  // namespace

Vector3d ContinuousRotation::log(const Eigen::Quaterniond& rotation) const noexcept {
    Eigen::Vector4d q = rotation.coeffs();
    if (q.dot(last_.coeffs()) < 0) q = -q;
    const double sine = q.head<3>().norm();
    if (sine < 1e-9 && q.w() > 0) return 2 * q.head<3>();
    double angle = 2 * pinned::atan2(sine, q.w());
    if (angle > kLongestWay) {
        q = -q;
        angle = 2 * M_PI - angle;
    }
    return sine < 1e-300 ? Vector3d(angle, 0, 0) : Vector3d(angle / sine * q.head<3>());
}

void ContinuousRotation::remember(const Eigen::Quaterniond& rotation) noexcept {
    Eigen::Vector4d q = rotation.coeffs();
    if (q.dot(last_.coeffs()) < 0) q = -q;
    if (2 * pinned::atan2(q.head<3>().norm(), q.w()) > kLongestWay) q = -q;
    last_ = Eigen::Quaterniond(q);
}

EnergyTerm couplingEnergy(const EnergyCoupling& coupling, const Pose& X_VT, const Pose& X_VT_device,
                          const ContinuousRotation& way) noexcept {
    const Vector3d r = X_VT.rotation * coupling.p_TG;
    const Vector3d stretch = X_VT_device * coupling.p_TG - X_VT.position - r;
    const Spring force = springAt(coupling.translation_stiffness, coupling.saturation_force, stretch.norm());

    const Vector3d theta = way.log(fromSpoToDevice(X_VT, X_VT_device));
    const double angle = theta.norm();
    const Spring torque = springAt(coupling.rotation_stiffness, coupling.saturation_torque, angle);

    EnergyTerm term;
    addSpring(term, r, springVector(stretch, force), force.energy,
              directional(stretch, force.slope, force.secant, coupling.translation_stiffness));
    term.energy += torque.energy;
    term.wrench.torque += springVector(theta, torque);
    term.stiffness.bottomRightCorner<3, 3>() +=
        directional(theta, torque.slope, torque.secant * halfCotangent(angle), coupling.rotation_stiffness);
    return term;
}

Wrench couplingWrenchOnDevice(const EnergyCoupling& coupling, const Pose& X_VT, const Pose& X_VT_device,
                              const ContinuousRotation& way) noexcept {
    const Vector3d r = X_VT_device.rotation * coupling.p_TG;
    const Vector3d stretch = X_VT_device.position + r - X_VT * coupling.p_TG;
    const Spring force = springAt(coupling.translation_stiffness, coupling.saturation_force, stretch.norm());
    const Vector3d theta = way.log(fromSpoToDevice(X_VT, X_VT_device));
    const Spring torque = springAt(coupling.rotation_stiffness, coupling.saturation_torque, theta.norm());
    Wrench wrench;
    wrench.force = -springVector(stretch, force);
    wrench.torque = r.cross(wrench.force) - springVector(theta, torque);
    return wrench;
}

RelaxingSpring::RelaxingSpring(const EnergyCoupling& coupling, double dt) noexcept : dt_(dt) {
    setCoupling(coupling);
}

void RelaxingSpring::setCoupling(const EnergyCoupling& coupling) noexcept {
    coupling_ = coupling;
    share_ = dt_ / (coupling.relaxing_time + dt_);
    stiffness_ = coupling.relaxing_share * coupling.translation_stiffness * (1 - share_);
}

Vector3d RelaxingSpring::stretchOf(const Pose& X_VT, const Pose& X_VT_device) const noexcept {
    return X_VT_device * coupling_.p_TG - X_VT * coupling_.p_TG;
}

EnergyTerm RelaxingSpring::energy(const Pose& X_VT, const Pose& X_VT_device) const noexcept {
    EnergyTerm term;
    if (!has_memory_ || stiffness_ == 0) return term;
    const Vector3d r = X_VT.rotation * coupling_.p_TG;
    const Vector3d stretch = stretchOf(X_VT, X_VT_device) - followed_;
    const Spring spring = springAt(stiffness_, coupling_.saturation_force, stretch.norm());
    addSpring(term, r, springVector(stretch, spring), spring.energy,
              directional(stretch, spring.slope, spring.secant, stiffness_));
    return term;
}

Wrench RelaxingSpring::wrenchOnDevice(const Pose& X_VT, const Pose& X_VT_device) const noexcept {
    if (!has_memory_ || stiffness_ == 0) return {};
    const Vector3d stretch = stretchOf(X_VT, X_VT_device) - followed_;
    const Vector3d force =
        -springVector(stretch, springAt(stiffness_, coupling_.saturation_force, stretch.norm()));
    return {force, (X_VT_device.rotation * coupling_.p_TG).cross(force)};
}

void RelaxingSpring::follow(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    const Vector3d stretch = stretchOf(X_VT, X_VT_device);
    followed_ = has_memory_ ? Vector3d(followed_ + share_ * (stretch - followed_)) : stretch;
    has_memory_ = true;
}

EnergyTerm dampingEnergy(const EnergyCouplingConfig& config, const Pose& X_VT, const Pose& X_VT_before,
                         double dt) noexcept {
    const double share = config.damping_time / dt;
    const double k = share * config.translation_stiffness, k_rotation = share * config.rotation_stiffness;
    const Vector3d x = X_VT.position - X_VT_before.position;
    const Vector3d theta = logRotation(X_VT.rotation * X_VT_before.rotation.conjugate());
    EnergyTerm term;
    term.energy = 0.5 * (k * x.squaredNorm() + k_rotation * theta.squaredNorm());
    term.wrench = {-k * x, -k_rotation * theta};
    term.stiffness.topLeftCorner<3, 3>().diagonal().setConstant(k);
    term.stiffness.bottomRightCorner<3, 3>().diagonal().setConstant(k_rotation);
    return term;
}

}  // namespace bonemill
