#include "common/geometry/pose.h"

#include <cmath>

#include "common/base/assert.h"
#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

// Below this angle sin and atan2 are replaced by their series, whose error is below 1e-18.
constexpr double kSmallAngle_rad = 1e-6;
constexpr double kOpposite = 1e-8;  // of the sum of two unit vectors: its direction is noise

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Eigen::Quaterniond expRotation(const Eigen::Vector3d& theta) noexcept {
    const double angle = theta.norm();
    const double scale = angle < kSmallAngle_rad ? 0.5 - angle * angle / 48 : pinned::sin(angle / 2) / angle;
    const Eigen::Vector3d v = scale * theta;
    return {pinned::cos(angle / 2), v.x(), v.y(), v.z()};
}

Eigen::Vector3d logRotation(const Eigen::Quaterniond& q) noexcept {
    BONEMILL_ASSERT(
        !(std::abs(q.squaredNorm() - 1) > 1e-6));  // of what is not finite comes what is not finite
    const double sign = q.w() < 0 ? -1.0 : 1.0;
    const Eigen::Vector3d v = sign * q.vec();
    const double sine = v.norm();
    const double cosine = sign * q.w();
    if (sine < kSmallAngle_rad) return 2 * v / cosine;
    return 2 * pinned::atan2(sine, cosine) / sine * v;
}

Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
    const Eigen::Vector3d a = from.normalized();
    const Eigen::Vector3d sum = a + to.normalized();
    const double length = sum.norm();
    const Eigen::Vector3d half = sum / length;  // half of the way
    const Eigen::Vector3d v = length < kOpposite ? a.unitOrthogonal() : a.cross(half);
    return Eigen::Quaterniond(length < kOpposite ? 0 : a.dot(half), v.x(), v.y(), v.z()).normalized();
}

Pose Pose::operator*(const Pose& other) const noexcept {
    return {rotation * other.position + position, (rotation * other.rotation).normalized()};
}

Pose Pose::inverse() const noexcept {
    const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
    return {-(inverse_rotation * position), inverse_rotation};
}

Pose Pose::incremented(const Eigen::Vector3d& translation,
                       const Eigen::Vector3d& rotation_vector) const noexcept {
    return {position + translation, (expRotation(rotation_vector) * rotation).normalized()};
}

bool Pose::isFinite() const noexcept {
    return position.allFinite() && rotation.coeffs().allFinite();
}

Wrench Wrench::operator+(const Wrench& other) const noexcept {
    return {force + other.force, torque + other.torque};
}

Wrench Wrench::operator-() const noexcept {
    return {-force, -torque};
}

Wrench Wrench::rotatedBy(const Eigen::Quaterniond& R_AB) const noexcept {
    return {R_AB * force, R_AB * torque};
}

bool Wrench::isFinite() const noexcept {
    return force.allFinite() && torque.allFinite();
}

Vector6d between(const Pose& X_VT_from, const Pose& X_VT_to) noexcept {
    Vector6d step;
    step << X_VT_to.position - X_VT_from.position,
        logRotation(X_VT_to.rotation * X_VT_from.rotation.conjugate());
    return step;
}

Vector6d stacked(const Wrench& wrench) noexcept {
    Vector6d w;
    w << wrench.force, wrench.torque;
    return w;
}

}  // namespace bonemill
