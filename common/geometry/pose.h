// Here are rigid poses, the exponential and the logarithm of rotations, and wrenches.
//
// The conventions are those of docs/reference/frames.md: X_AB maps coordinates in frame B to frame A, and
// increments in the world are p+ = p + x, R+ = exp(omega~) R. Units are m, rad, N, N·m. Every function is
// RT-safe and thread-safe, and none throws.
//
// Only what loops over points call is inline: every source that reads an expression of Eigen compiles it
// anew.
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
    Pose operator*(const Pose& other) const noexcept;
    Pose inverse() const noexcept;
    // The increments are in the outer frame: p+ = p + translation, q+ = exp(rotation_vector / 2) q.
    Pose incremented(const Eigen::Vector3d& translation,
                     const Eigen::Vector3d& rotation_vector) const noexcept;
    bool isFinite() const noexcept;
};

// A wrench is a force (N) and a torque (N·m) about a stated point, in a stated frame.
struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();

    Wrench operator+(const Wrench& other) const noexcept;
    Wrench operator-() const noexcept;
    // Expresses this wrench of frame B in frame A; the reference point stays.
    Wrench rotatedBy(const Eigen::Quaterniond& R_AB) const noexcept;
    bool isFinite() const noexcept;
};

// Returns the way from one pose to the other in V: translation (m) above the rotation vector (rad).
Vector6d between(const Pose& X_VT_from, const Pose& X_VT_to) noexcept;

// Returns force above torque: times a way from between(), about the pose's origin, it is the wrench's work.
Vector6d stacked(const Wrench& wrench) noexcept;

}  // namespace bonemill
