// Takes what a vendor's library says in its own axes to D, and wrenches back.
//
// R_DV is one of the rotations that docs/howto/bridges.md lists, V the vendor's axes. The handle's frame T is
// the vendor's own handle frame with D's axes: a handle that the vendor calls not turned is not turned in D.
//
// Everything is RT-safe, and any thread may call it.
#pragma once

#include <Eigen/SVD>
#include <optional>

#include "common/geometry/pose.h"

namespace bonemill::bridge {

// Returns the rotation nearest to a matrix that should be one; nothing when it is far from all of them, or
// not finite.
inline std::optional<Eigen::Quaterniond> repairedRotation(const Eigen::Matrix3d& matrix) noexcept {
    constexpr double kMaxStretch = 0.1;  // a rotation stretches nothing; vendors' are wrong by less than 1e-3
    if (!matrix.allFinite()) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.info() != Eigen::Success) return std::nullopt;
    const Eigen::Array3d stretches = svd.singularValues();
    if ((stretches - 1).abs().maxCoeff() > kMaxStretch || matrix.determinant() <= 0) return std::nullopt;
    const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
    return Eigen::Quaterniond(rotation).normalized();
}

inline Pose poseInD(const Eigen::Matrix3d& R_DV, const Eigen::Vector3d& p_V,
                    const Eigen::Quaterniond& R_V) noexcept {
    const Eigen::Quaterniond turn(R_DV);
    return {R_DV * p_V, (turn * R_V * turn.conjugate()).normalized()};
}

// Expresses a wrench of D in the vendor's axes.
inline Wrench wrenchInV(const Eigen::Matrix3d& R_DV, const Wrench& wrench_D) noexcept {
    return {R_DV.transpose() * wrench_D.force, R_DV.transpose() * wrench_D.torque};
}

}  // namespace bonemill::bridge
