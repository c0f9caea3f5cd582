// Takes what a vendor's library says in its own axes to D, and wrenches back.
//
// R_DV is one of the rotations that docs/lab/bridges.md lists, V the vendor's axes. The handle's frame T is
// the vendor's own handle frame with D's axes: a handle that the vendor calls not turned is not turned in D.
//
// Everything is RT-safe, and any thread may call it.
#pragma once

#include <optional>

#include "common/geometry/pose.h"

namespace bonemill::bridge {

// Returns the rotation nearest to a matrix that should be one; nothing when it is far from all of them, or
// not finite.
std::optional<Eigen::Quaterniond> repairedRotation(const Eigen::Matrix3d& matrix) noexcept;

Pose poseInD(const Eigen::Matrix3d& R_DV, const Eigen::Vector3d& p_V, const Eigen::Quaterniond& R_V) noexcept;

// Expresses a wrench of D in the vendor's axes.
Wrench wrenchInV(const Eigen::Matrix3d& R_DV, const Wrench& wrench_D) noexcept;

}  // namespace bonemill::bridge
