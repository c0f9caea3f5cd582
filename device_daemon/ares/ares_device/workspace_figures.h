// How far the handle may go: figures of the workspace for people, and for the server that adapts to it.
//
// They are sampled in fixed directions, and take milliseconds: for start-up. Units are m, rad.
#pragma once

#include "device_daemon/ares/kinematics/ares_kinematics.h"

namespace bonemill {

inline constexpr double kSpecifiedTurn = 0.6981317007977318;  // rad: 40 degrees, what ARES was asked for

// Returns the radius of the largest ball around D's origin in which the handle may be turned by `turn` about
// any axis without leaving the workspace or coming near a singularity.
double reachRadius(const AresKinematics& kinematics, double turn) noexcept;

}  // namespace bonemill
