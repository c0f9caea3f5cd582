// It is a simulated haptic device with the user's hand on its handle, in Cartesian coordinates, which the
// loop must stay stable with.
//
// One rigid body carries the device's and the hand's mass and inertia (isotropic, about the tool point). On
// it act the commanded wrench after the amplifiers' first-order pole, viscous and Coulomb friction of the
// device, the hand's spring and damper towards its target, and a constant bias (a weight when no hand holds
// the handle). The ranges of the defaults are in docs/explanation/stability.md. It is integrated by leapfrog
// at kRate_hz or finer; friction is implicit, so that the body truly sticks and Coulomb friction cannot
// chatter. Units are SI, axes W. It is deterministic.
#pragma once

#include "common/geometry/pose.h"
#include "device_daemon/ares/driver/ares_emulator.h"

namespace bonemill::test {

struct DevicePlant {
    double mass = 0.25;                      // kg
    double damping = 2;                      // N·s/m
    double coulomb = 0.2;                    // N
    double inertia = 5e-5;                   // kg·m²
    double angular_damping = 0.004;          // N·m·s/rad
    double angular_coulomb = 1e-3;           // N·m
    double amplifier_hz = 500;               // pole
    double encoder_step = 5e-6;              // m; 0 is an ideal encoder
    double encoder_angle = 1.745329252e-04;  // rad (0.01°); 0 is an ideal encoder
};

using HandPlant = HandImpedance;
inline constexpr HandPlant kNoHand{0, 0, 0, 0, 0, 0};

class Plant {
  public:
    static constexpr double kRate_hz = 40'000;

    // It is at rest at `start`, which is also the hand's target. Total mass and inertia must be positive.
    Plant(const DevicePlant& device, const HandPlant& hand, const Pose& start)
        : device_(device), hand_(hand), pose_(start), target_(start), zero_(start) {}

    // Lives through dt with this wrench commanded to the amplifiers.
    void advance(double dt, const Wrench& command) noexcept;

    void setTarget(const Pose& target, const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) noexcept {
        target_ = target;
        target_velocity_ = velocity;
    }
    void setBias(const Wrench& bias) noexcept { bias_ = bias; }
    void setVelocity(const Eigen::Vector3d& v, const Eigen::Vector3d& w) noexcept { v_ = v, w_ = w; }

    const Pose& pose() const noexcept { return pose_; }
    const Eigen::Vector3d& velocity() const noexcept { return v_; }
    const Eigen::Vector3d& angularVelocity() const noexcept { return w_; }
    // The encoders say the position in whole steps per axis, and the rotation vector from the
    // start pose the same.
    Pose measured() const noexcept;
    // Returns the kinetic energy and what the hand's springs hold, J.
    double energy() const noexcept;

  private:
    void substep(double h, const Wrench& command) noexcept;

    DevicePlant device_;
    HandPlant hand_;
    Pose pose_;
    Pose target_;
    Pose zero_;
    Eigen::Vector3d target_velocity_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_ = Eigen::Vector3d::Zero();
    Wrench bias_;
    Wrench drive_;  // after the amplifiers
};

}  // namespace bonemill::test
