// Finds the handle pose that six slider positions mean, or says that it does not know.
//
// Six slider positions fit several poses: a six-legged platform has up to 40 assemblies. Only one of them
// lies in the workspace that may be believed: turned by no more than kMaxTurn, assembled as the neutral pose,
// better conditioned than kMinSingularityIndex, and within stroke and lean. That there is no second one is
// measured, not proved: tests/property/device_daemon/ares/kinematics. It is RT-safe and pure; units and
// frames are those of ares_kinematics.h.
#pragma once

#include "device_daemon/ares/kinematics/ares_kinematics.h"

namespace bonemill {

// Encoders, and a stop that gives way, may show so much beyond stroke and lean (m).
inline constexpr double kWorkspaceSlack = 1e-3;

struct Location {
    bool is_found = false;  // X_DT has these slider positions, whether or not it may be believed
    uint32_t faults = kWorkspaceUnreachable;  // WorkspaceFault bits; without any it may be believed
    Pose X_DT;
    Matrix6d J_inv = Matrix6d::Zero();  // there
    double singularity_index = 0;       // there

    bool isBelieved() const noexcept { return is_found && faults == kWorkspaceOk; }
};

// Searches from X_DT_start: the pose of a moment ago, or the neutral one. Whoever follows a moving handle
// must always start from its last pose, also where that was not believed: a search from elsewhere could find
// a pose that looks well while the handle is in an assembly that does not.
Location locate(const AresKinematics& kinematics, const Vector6d& q, const Pose& X_DT_start) noexcept;

}  // namespace bonemill
