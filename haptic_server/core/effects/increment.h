// The tool's way from one pose to another is what effects' energies are functions of: x of the tool point,
// and the rotation vector θ. It is RT-safe.
#pragma once

#include <cmath>

#include "common/geometry/pose.h"
#include "common/math/pinned_math.h"

namespace bonemill {

struct Increment {
    Increment(const Pose& from, const Pose& to) noexcept : twist(between(from, to)) {}
    auto translation() const noexcept { return twist.head<3>(); }  // m
    auto rotation() const noexcept { return twist.tail<3>(); }     // rad

    // An energy's gradient by the world increment at `to`, from its gradient by x and θ: a further turn ω
    // changes θ by J⁻¹ω, J the left Jacobian of the rotation group, so the torque is J⁻ᵀ times that of θ.
    Wrench wrenchOf(const Wrench& of_twist) const noexcept {
        const Eigen::Vector3d theta = rotation(), across = theta.cross(of_twist.torque);
        return {of_twist.force, of_twist.torque + 0.5 * across + curvature() * theta.cross(across)};
    }

    Vector6d twist;

  private:
    // Returns 1/θ² − (1 + cos θ)/(2 θ sin θ); Barfoot, State Estimation for Robotics (2017), ch. 7.
    double curvature() const noexcept {
        const double angle = rotation().norm(), half = angle / 2;
        if (angle < 1e-2) return (1 + angle * angle / 60) / 12;
        return (1 - half * pinned::cos(half) / pinned::sin(half)) / (angle * angle);
    }
};

}  // namespace bonemill
