// The way of a tool from one pose to another, as solves and effects take it.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

// Returns the way from one pose to the other in V: translation (m) above the rotation vector (rad). RT-safe.
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
