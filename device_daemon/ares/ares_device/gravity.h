// The weight of what moves with the handle, for an arm that no counterweight holds.
//
// The moving parts count as one rigid body on the platform; what the sliders and links weigh must be
// balanced, or lumped into it. Frames are D and T (docs/develop/frames.md), units kg, m, N, N·m. It is pure
// and RT-safe.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

struct MovingWeight {
    double mass = 0;                                     // kg; 0 for a counterweighted arm
    Eigen::Vector3d centre_T = Eigen::Vector3d::Zero();  // of the mass
    Eigen::Vector3d down_D = -Eigen::Vector3d::UnitZ();  // a unit vector: where things fall to
};

inline constexpr double kStandardGravity = 9.80665;  // m/s²

// Returns the wrench in D, about T's origin, that holds the weight up: the opposite of what gravity does.
Wrench holdingWrench(const MovingWeight& weight, const Pose& X_DT) noexcept;

// Returns the weight's potential energy (J), which is zero with its centre at D's origin.
double potentialEnergy(const MovingWeight& weight, const Pose& X_DT) noexcept;

}  // namespace bonemill
