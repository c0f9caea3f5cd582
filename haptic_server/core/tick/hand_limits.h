// Here are all limits between the computed wrench and the one that the hand feels, in this order.
//
// 1. Something to send. A tick without an equilibrium, or with a wrench that is not finite, has nothing to
//    say. The hand then gets the last wrench that it got, faded to nothing within kFade. This comes first,
//    because what is not a number can be compared with no limit.
// 2. The norms. Force and torque are scaled each by a factor of its own, so that each keeps its direction and
//    a torque beyond its limit takes nothing from the force. It is also what keeps the energy: the coupling's
//    force depends on its stretch and its torque on its turn, and cut at its own norm each is still the
//    gradient of an energy (but for the lever of a grip beside the tool point). With one factor the force
//    would depend on the turn as well, and a closed path of the hand could gain. This comes before the rate:
//    where the hand comes from and where it goes to are then both within the norms, and with them all that
//    lies between, so that the norms hold whatever the rate does. A wrench that was computed far beyond the
//    norms falls from what was sent, at once. Norms that come down with another device are reached at the
//    rate; what that device cannot give meanwhile, its daemon cuts. A norm of 0 says that the device has no
//    force or no torque: nobody can feel it go, so that it goes at once, and that is no limit that acted.
// 3. The rate, when what the hand feels has changed at one stroke. A larger burr may find bone where the
//    smaller one had room, restored bone may be where the tool is, another device may be held more stiffly,
//    an equilibrium may be found again after ticks without one, bone may give way when the pedal goes down,
//    the hand may be elsewhere than where it was last heard of, the last of a wall may go under the burr:
//    what is milled away in a tick is worth no more force than the rate. The wrench then goes from the old
//    one to the new one at kForceRate and kTorqueRate. This is for such events only: a limit on every tick's
//    force would hold back what the bone gives, and make loops unstable.
// 4. The factor of the stale ramp, 0 to 1. It comes last, so that no other limit can undo it: at 0 nothing is
//    sent, whatever was computed. The rate does not see it, for it would take the ramp for a change of the
//    wrench.
//
// All wrenches and poses are in V, torques about the tool point that the hand holds. It is RT-safe, for the
// tick thread only.
#pragma once

#include <algorithm>

#include "common/base/assert.h"
#include "common/geometry/bounded_vector.h"
#include "common/geometry/pose.h"

namespace bonemill {

struct HandLimitsConfig {
    double max_force = 50;  // N; 0: the hand feels no force
    double max_torque = 1;  // N·m; 0: the hand feels no torque
};

// A motion of the hand makes this of the wrench from one tick to the next, when nothing else changes.
struct HandSpring {
    double stiffness = 0;           // N/m of the tool's way
    double rotation_stiffness = 0;  // N·m/rad
    double lever = 0;               // m: of the force about the tool point
};

// A tick says this before the limits.
struct FeltStep {
    Wrench wrench_V;
    bool is_solved = true;  // false: there is no equilibrium, and the wrench says nothing
    Pose X_VT_device = {};
    double stale_factor = 1;
    bool is_milled = false;   // bone was taken away since the last step
    bool has_jumped = false;  // what X_VT_device has gone since the last step is no motion of the hand
};

class HandLimits {
  public:
    static constexpr double kForceRate = 100;  // N/s: from nothing to 10 N in 0.1 s
    static constexpr double kTorqueRate = 3;   // N·m/s: that force at 30 mm
    static constexpr double kQuiet = 0.05;     // s without a limit by the rate: the change is over
    // It is in s. One tick without an equilibrium takes 2 % of the force, which no hand feels. Many must not
    // hold it: the last force stays where it points while the hand moves on, so that it would drive the hand
    // without end. Over this time it falls by 1000 N/s at the most, as steeply as when the device falls
    // silent, which does not kick; and at the coupling's highest speed, 0.5 m/s, the hand is not driven
    // farther than 25 mm.
    static constexpr double kFade = 0.05;

    // The rate comes on top of what the hand's own motion makes by `spring`.
    HandLimits(const HandLimitsConfig& config, const HandSpring& spring, double dt) noexcept
        : config_(config), spring_(spring), dt_(dt) {
        BONEMILL_ASSERT(dt > 0);
    }

    // Another device is in the hand from the next tick on.
    void setDevice(const HandLimitsConfig& config, const HandSpring& spring) noexcept {
        config_ = config;
        spring_ = spring;
        leaveOut(last_);
        leaveOut(before_fading_);
        beginSuddenChange();
    }
    // Says that what is felt changes at one stroke from now on.
    void beginSuddenChange() noexcept { quiet_for_ = 0; }
    bool isChangeOver() const noexcept { return quiet_for_ > kQuiet; }

    // Called once per tick, it returns the wrench to send.
    Wrench limit(const FeltStep& step) noexcept {
        was_limited_ = false;
        Wrench wrench = step.is_solved && step.wrench_V.isFinite() ? allowed(step) : faded(step);
        last_ = wrench;
        X_VT_device_ = step.X_VT_device;
        const double factor = step.stale_factor > 0 ? std::min(step.stale_factor, 1.0) : 0;
        wrench.force *= factor;
        wrench.torque *= factor;
        return wrench;
    }
    // Tells whether the last wrench was beyond the norms, or not finite.
    bool wasLimited() const noexcept { return was_limited_; }

  private:
    Wrench faded(const FeltStep& step) noexcept {
        was_limited_ = !step.wrench_V.isFinite();
        beginSuddenChange();
        faded_for_ += dt_;
        const double share = std::max(0.0, 1 - faded_for_ / kFade);
        return {share * before_fading_.force, share * before_fading_.torque};
    }

    Wrench allowed(const FeltStep& step) noexcept {
        Wrench wrench = step.wrench_V;
        leaveOut(wrench);
        was_limited_ =
            limitLength(wrench.force, config_.max_force) | limitLength(wrench.torque, config_.max_torque);
        if (step.is_milled && fallsAtOnce(wrench, step)) beginSuddenChange();
        if (!isChangeOver()) slowDown(wrench, step.has_jumped ? X_VT_device_ : step.X_VT_device);
        faded_for_ = 0;
        before_fading_ = wrench;
        return wrench;
    }

    void leaveOut(Wrench& wrench) const noexcept {
        if (config_.max_force == 0) wrench.force.setZero();
        if (config_.max_torque == 0) wrench.torque.setZero();
    }

    bool fallsAtOnce(const Wrench& wrench, const FeltStep& step) const noexcept {
        const double moved = spring_.stiffness * (step.X_VT_device.position - X_VT_device_.position).norm();
        return last_.force.norm() - wrench.force.norm() > kForceRate * dt_ + moved;
    }

    void slowDown(Wrench& wrench, const Pose& X_VT_device) noexcept {
        const double moved = spring_.stiffness * (X_VT_device.position - X_VT_device_.position).norm();
        const double turned = spring_.rotation_stiffness *
                              logRotation(X_VT_device.rotation * X_VT_device_.rotation.conjugate()).norm();
        const bool is_whole =
            approach(last_.force, kForceRate * dt_ + moved, wrench.force) &
            approach(last_.torque, kTorqueRate * dt_ + turned + spring_.lever * moved, wrench.torque);
        quiet_for_ = is_whole ? quiet_for_ + dt_ : 0;
    }
    // Brings the value no farther from `last` than `most`. False says that this cut it short.
    static bool approach(const Eigen::Vector3d& last, double most, Eigen::Vector3d& value) noexcept {
        Eigen::Vector3d change = value - last;
        if (!limitLength(change, most)) return true;
        value = last + change;
        return false;
    }

    HandLimitsConfig config_;
    HandSpring spring_;
    double dt_;
    double quiet_for_ = 2 * kQuiet;  // s
    double faded_for_ = 0;           // s
    Wrench before_fading_;           // of the last tick that had something to say, but for the stale factor
    Wrench last_;                    // what was sent last, but for the stale factor
    Pose X_VT_device_;
    bool was_limited_ = false;
};

}  // namespace bonemill
