// Here are rigid poses, the exponential and the logarithm of rotations, and wrenches.
//
// The conventions are those of docs/reference/frames.md: X_AB maps coordinates in frame B to frame A, and
// increments in the world are p+ = p + x, R+ = exp(omega~) R. Units are m, rad, N, N·m. Every function is
// RT-safe and thread-safe, and none throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace bonemill {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Returns the skew matrix v~ with v~ x = v × x.
Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept;

// Returns the unit quaternion of the rotation vector theta (rad), by its series below 1e-6 rad.
Eigen::Quaterniond expRotation(const Eigen::Vector3d& theta) noexcept;

// Returns the rotation vector (rad, norm <= pi) of a unit quaternion, by its series below 1e-6 rad. The
// result is the same for q and -q.
Eigen::Vector3d logRotation(const Eigen::Quaterniond& q) noexcept;

// Returns the shortest rotation that turns direction `from` to direction `to`, which may have any length but
// 0; for opposite ones it is half a turn about an axis across them.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept;

// The pose of frame B in frame A maps p_A = R_AB p_B + p_AB. Its rotation is a unit quaternion.
struct Pose {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

    Eigen::Vector3d operator*(const Eigen::Vector3d& point) const noexcept {
        return rotation * point + position;
    }
    Pose operator*(const Pose& other) const noexcept {
        return {rotation * other.position + position, (rotation * other.rotation).normalized()};
    }
    Pose inverse() const noexcept {
        const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
        return {-(inverse_rotation * position), inverse_rotation};
    }
    // The increments are in the outer frame: p+ = p + translation, q+ = exp(rotation_vector / 2) q.
    Pose incremented(const Eigen::Vector3d& translation,
                     const Eigen::Vector3d& rotation_vector) const noexcept {
        return {position + translation, (expRotation(rotation_vector) * rotation).normalized()};
    }
    bool isFinite() const noexcept { return position.allFinite() && rotation.coeffs().allFinite(); }
};

// A wrench is a force (N) and a torque (N·m) about a stated point, in a stated frame.
struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();

    Wrench operator+(const Wrench& other) const noexcept {
        return {force + other.force, torque + other.torque};
    }
    Wrench operator-() const noexcept { return {-force, -torque}; }
    // Expresses this wrench of frame B in frame A; the reference point stays.
    Wrench rotatedBy(const Eigen::Quaterniond& R_AB) const noexcept { return {R_AB * force, R_AB * torque}; }
    bool isFinite() const noexcept { return force.allFinite() && torque.allFinite(); }
};

// Returns the way from one pose to the other in V: translation (m) above the rotation vector (rad).
inline Vector6d between(const Pose& X_VT_from, const Pose& X_VT_to) noexcept {
    Vector6d step;
    step << X_VT_to.position - X_VT_from.position,
        logRotation(X_VT_to.rotation * X_VT_from.rotation.conjugate());
    return step;
}

// Returns force above torque: times a way from between(), about the pose's origin, it is the wrench's work.
inline Vector6d stacked(const Wrench& wrench) noexcept {
    Vector6d w;
    w << wrench.force, wrench.torque;
    return w;
}

}  // namespace bonemill
