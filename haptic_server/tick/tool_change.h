// What the hand feels of a change of the tool: the way from the old tool's wrench to the new one's, at a
// limited rate. A larger burr may find bone where there was room for the smaller one: the simulated tool is
// out of it within some ticks, and the coupling's pull would grow as fast. RT-safe; tick thread only.
#pragma once

#include <algorithm>

#include "common/geometry/pose.h"

namespace bonemill {

class ToolChange {
  public:
    static constexpr double kForceRate = 100;  // N/s: from nothing to 10 N in 0.1 s
    static constexpr double kTorqueRate = 3;   // N·m/s: that force at 30 mm
    static constexpr double kQuiet = 0.05;     // s without a limit: the change is over

    // Beside the rates the wrench may change by what the hand's own motion makes of these, N/m and N·m/rad,
    // with the force's lever about the tool point, m.
    ToolChange(double dt, double stiffness, double rotation_stiffness, double lever) noexcept
        : dt_(dt), stiffness_(stiffness), rotation_stiffness_(rotation_stiffness), lever_(lever) {}

    void begin() noexcept { quiet_for_ = 0; }
    bool isOver() const noexcept { return quiet_for_ > kQuiet; }

    // Every tick: the wrench to send instead of the one that was computed.
    Wrench next(const Wrench& computed, const Pose& device) noexcept {
        if (!computed.isFinite()) return computed;
        Wrench sent = computed;
        if (!isOver()) {
            const double moved = stiffness_ * (device.position - device_.position).norm();
            const double turned =
                rotation_stiffness_ * logRotation(device.rotation * device_.rotation.conjugate()).norm();
            const bool is_whole =
                approach(last_.force, kForceRate * dt_ + moved, sent.force) &
                approach(last_.torque, kTorqueRate * dt_ + turned + lever_ * moved, sent.torque);
            quiet_for_ = is_whole ? quiet_for_ + dt_ : 0;
        }
        last_ = sent;
        device_ = device;
        return sent;
    }

  private:
    // No farther from `last` than `most`. False: that cut it short.
    static bool approach(const Eigen::Vector3d& last, double most, Eigen::Vector3d& value) noexcept {
        const Eigen::Vector3d change = value - last;
        const double size = change.norm();
        if (size <= most) return true;
        value = last + change * (most / size);
        return false;
    }

    double dt_, stiffness_, rotation_stiffness_, lever_;
    double quiet_for_ = 2 * kQuiet;  // s
    Wrench last_;
    Pose device_;
};

}  // namespace bonemill
