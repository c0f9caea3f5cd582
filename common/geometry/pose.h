// Rigid poses, rotation exponential and logarithm, wrenches.
//
// Conventions (docs/frames.md): X_AB maps coordinates in frame B to frame A; world increments are
// p+ = p + x, R+ = exp(omega~) R. Units m, rad, N, N·m. Every function is RT-safe, thread-safe and never
// throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace bonemill {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Skew matrix v~ with v~ x = v × x.
Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept;

// Unit quaternion of the rotation vector theta (rad); series below 1e-6 rad.
Eigen::Quaterniond expRotation(const Eigen::Vector3d& theta) noexcept;

// Rotation vector (rad, norm <= pi) of a unit quaternion; series below 1e-6 rad. q and -q give the same
// result.
Eigen::Vector3d logRotation(const Eigen::Quaterniond& q) noexcept;

// The shortest rotation that turns direction `from` to direction `to` (any length, not 0); of opposite ones
// half a turn about an axis across them.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept;

// Pose of frame B in frame A: p_A = R_AB p_B + p_AB. `rotation` is a unit quaternion.
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
    // p+ = p + translation, q+ = exp(rotation_vector / 2) q: increments in the world (outer) frame.
    Pose incremented(const Eigen::Vector3d& translation,
                     const Eigen::Vector3d& rotation_vector) const noexcept {
        return {position + translation, (expRotation(rotation_vector) * rotation).normalized()};
    }
    bool isFinite() const noexcept { return position.allFinite() && rotation.coeffs().allFinite(); }
};

// Force (N) and torque (N·m) about a stated point, in a stated frame.
struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();

    Wrench operator+(const Wrench& other) const noexcept {
        return {force + other.force, torque + other.torque};
    }
    Wrench operator-() const noexcept { return {-force, -torque}; }
    // The same wrench expressed in frame A, when this one is expressed in frame B; the reference point stays.
    Wrench rotatedBy(const Eigen::Quaterniond& R_AB) const noexcept { return {R_AB * force, R_AB * torque}; }
    bool isFinite() const noexcept { return force.allFinite() && torque.allFinite(); }
};

}  // namespace bonemill
