// This is a handle that exists only as numbers, for devices that sense a wish but have no motors: a mouse, a
// joystick. A simulated hand draws a small body towards the wish, and the wrench of haptic_server pushes it.
//
// The farther the wish lies inside the bone, the harder the hand presses, up to its strength and never
// harder: only what draws towards the wish is bounded; the damping, which takes energy out, never is. It
// holds still against a wall of kMaxStiffness with one period of delay. Gravity does not act.
//
// The frames are D, the device's base, and T, the handle; units are SI. It is deterministic and RT-safe, for
// one thread.
#pragma once

#include <string_view>

#include "common/geometry/pose.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// Makes a smooth motion of wishes that come in steps: poses of a mouse or of a slow sensor, 30 to 60 per
// second, become a motion at the loop's rate. Between two wishes it goes straight, in the mean time that lies
// between wishes. A critically damped follower of second order with bounded speed and acceleration trails
// that: it does not overshoot, and comes to rest at the wish.
class MotionFilter {
  public:
    static constexpr double kBandwidth = 60;        // rad/s: it trails by 2 / kBandwidth
    static constexpr double kMaxSpeed = 0.3;        // m/s
    static constexpr double kMaxAcceleration = 20;  // m/s²
    static constexpr double kMaxSpin = 4;           // rad/s
    static constexpr double kMaxSpinChange = 300;   // rad/s²
    static constexpr double kShortestInterval = 0.005, kLongestInterval = 0.06;  // s between wishes

    // Rests at this pose, and wants to stay there.
    explicit MotionFilter(const Pose& X_DT_start) noexcept
        : X_DT_(X_DT_start), X_DT_way_(X_DT_start), X_DT_wanted_(X_DT_start) {}

    void want(const Pose& X_DT) noexcept;
    // Goes on by `dt`, a small part of 1 / kBandwidth.
    void advance(double dt) noexcept;

    const Pose& pose() const noexcept { return X_DT_; }
    const Eigen::Vector3d& v_DT() const noexcept { return v_DT_; }  // m/s
    const Eigen::Vector3d& w_DT() const noexcept { return w_DT_; }  // rad/s, in D

  private:
    void goToWish(double dt) noexcept;

    Pose X_DT_;
    Pose X_DT_way_;  // on the straight way to the wish
    Pose X_DT_wanted_;
    double interval_ = 1.0 / 30;            // s: mean time between wishes
    double since_wish_ = kLongestInterval;  // s
    double way_time_ = 0;                   // s until the way is done
    Eigen::Vector3d v_DT_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT_ = Eigen::Vector3d::Zero();
};

// The body weighs what moves along in the emulated ARES, and the spring is that of its simulated hand. The
// damping is critical.
struct VirtualHand {
    double mass = 0.25;              // kg
    double inertia = 1e-4;           // kg·m², about every axis
    double stiffness = 600;          // N/m
    double angular_stiffness = 1.0;  // N·m/rad
    double max_force = 8;            // N: as hard as a hand presses a burr on bone
    double max_torque = 0.1;         // N·m
};

class VirtualHandle {
  public:
    static constexpr double kMaxStiffness = 4000;       // N/m
    static constexpr double kMaxRotationStiffness = 2;  // N·m/rad
    static constexpr double kReach = 0.5;               // m around D's origin; the handle stays within
    static constexpr double kLongestElapsed = 0.05;     // s: for the rest of a longer pause it stands still

    explicit VirtualHandle(const Pose& X_DT_start, const VirtualHand& hand = {}) noexcept;

    // The hand wants the handle there from now on. The wish may come in steps; it is finite, and what lies
    // beyond kReach is drawn in.
    void want(const Pose& X_DT) noexcept;
    // The hand has it there of a sudden, at rest, and wants it there. As want() otherwise.
    void place(const Pose& X_DT) noexcept;
    // The hand wants it where it is now.
    void letGo() noexcept { motion_.want(X_DT_); }
    // Moves the handle by `elapsed` under this wrench on the hand; what is not finite counts as none.
    void advance(double elapsed, const Wrench& wrench_D) noexcept;

    const Pose& pose() const noexcept { return X_DT_; }
    const Eigen::Vector3d& v_DT() const noexcept { return v_DT_; }  // m/s
    const Eigen::Vector3d& w_DT() const noexcept { return w_DT_; }  // rad/s, in D

  private:
    void substep(double h, const Wrench& wrench_D) noexcept;

    VirtualHand hand_;
    double damping_, angular_damping_;  // N·s/m, N·m·s/rad
    MotionFilter motion_;
    Pose X_DT_;
    Eigen::Vector3d v_DT_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT_ = Eigen::Vector3d::Zero();
};

// What every device whose handle is a VirtualHandle says of itself and gives to the loop: wrenches are on the
// hand, in D.
//
// The hand is weaker than this, so that it never wins.
inline constexpr double kMaxHandleForce = 10;     // N
inline constexpr double kMaxHandleTorque = 0.15;  // N·m

// A name that is too long is cut.
DeviceCapabilities handleCapabilities(DeviceKind kind, std::string_view name) noexcept;

// What the hand feels of an order. Before it is engaged there is nothing to feel, and afterwards it fades:
// such a handle never feels anything but what is ordered.
Wrench feltWrench(const DeviceOrder& order) noexcept;

// `felt_D` is what the handle has felt since the last reading.
DeviceReading readingOf(const VirtualHandle& handle, const Wrench& felt_D, uint32_t buttons) noexcept;

}  // namespace bonemill
