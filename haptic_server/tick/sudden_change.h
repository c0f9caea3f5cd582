// The last before the hand: the limits of what it may feel, and, when what it feels has changed at one
// stroke, the way from the old wrench to the new one at a limited rate. A larger burr may find bone where
// there was room for the smaller one, a restored bone may be where the tool is: the simulated tool is out of
// it within some ticks, and the coupling's pull would grow as fast. RT-safe; tick thread only.
#pragma once

#include "haptic_server/coupling/virtual_coupling.h"

namespace bonemill {

class SuddenChange {
  public:
    static constexpr double kForceRate = 100;  // N/s: from nothing to 10 N in 0.1 s
    static constexpr double kTorqueRate = 3;   // N·m/s: that force at 30 mm
    static constexpr double kQuiet = 0.05;     // s without a limit: the change is over

    // Beside the rates the wrench may change by what the hand's own motion makes of these, N/m and N·m/rad,
    // with the force's lever about the tool point, m. Of `limits`, the largest force and torque.
    SuddenChange(const CouplingConfig& limits, double dt, double stiffness, double rotation_stiffness,
                 double lever) noexcept
        : limits_(limits),
          dt_(dt),
          stiffness_(stiffness),
          rotation_stiffness_(rotation_stiffness),
          lever_(lever) {}

    void begin() noexcept { quiet_for_ = 0; }
    bool isOver() const noexcept { return quiet_for_ > kQuiet; }

    // Every tick: makes of the computed wrench the one to send. True: limitWrench() changed it. The rate
    // comes after: what lies between two wrenches within the limits is within them too. Not finite: zero at
    // once.
    bool limit(Wrench& wrench, const Pose& device) noexcept {
        const bool is_finite = wrench.isFinite();
        const bool is_clamped = limitWrench(limits_, wrench);
        if (is_finite && !isOver()) slowDown(wrench, device);
        last_ = wrench;
        device_ = device;
        return is_clamped;
    }

  private:
    void slowDown(Wrench& wrench, const Pose& device) noexcept {
        const double moved = stiffness_ * (device.position - device_.position).norm();
        const double turned =
            rotation_stiffness_ * logRotation(device.rotation * device_.rotation.conjugate()).norm();
        const bool is_whole =
            approach(last_.force, kForceRate * dt_ + moved, wrench.force) &
            approach(last_.torque, kTorqueRate * dt_ + turned + lever_ * moved, wrench.torque);
        quiet_for_ = is_whole ? quiet_for_ + dt_ : 0;
    }
    // No farther from `last` than `most`. False: that cut it short.
    static bool approach(const Eigen::Vector3d& last, double most, Eigen::Vector3d& value) noexcept {
        const Eigen::Vector3d change = value - last;
        const double size = change.norm();
        if (size <= most) return true;
        value = last + change * (most / size);
        return false;
    }

    CouplingConfig limits_;
    double dt_, stiffness_, rotation_stiffness_, lever_;
    double quiet_for_ = 2 * kQuiet;  // s
    Wrench last_;                    // sent
    Pose device_;
};

}  // namespace bonemill
