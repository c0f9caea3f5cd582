// The last stop before the motors: finite -> rate -> clamp, in actuator forces.
//
// Scaling is by one factor over all six actuators, so that a limit never turns the wrench's direction: the
// hand then feels too little, not something else. RT-safe, one thread. Units N, N·m, s.
#pragma once

#include "device_daemon/kinematics/ares_kinematics.h"

namespace bonemill {

struct ForceLimits {
    double max_actuator_force = 50;  // N per actuator
    // N/s per actuator. The steepest honest demand is the coupling's: 3 N/mm at its speed limit of 0.5 m/s is
    // 1500 N/s on the handle, about as much per actuator; this is several times more, and still takes 5 ms to
    // full force.
    double max_actuator_force_rate = 10000;
};

// What the limiter did (bit mask).
enum ForceLimitEvent : uint32_t {
    kForceNotLimited = 0,
    kForceNotFinite =
        1u << 0,  // wrench or Jacobian unusable: the force goes to zero as fast as the rate allows
    kForceRateLimited = 1u << 1,
    kForceClamped = 1u << 2,
};

class ForceLimiter {
  public:
    explicit ForceLimiter(const ForceLimits& limits = {}) noexcept : limits_(limits) {}

    // Actuator forces for `wrench` (on the hand, in D about T's origin), dt after the last call. Always
    // finite, never beyond max_actuator_force.
    Vector6d limit(const Wrench& wrench, const Matrix6d& J_inv, double dt) noexcept;

    // The same without a usable pose: forces go to zero as fast as the rate allows.
    Vector6d fadeOut(double dt) noexcept;

    uint32_t events() const noexcept { return events_; }  // ForceLimitEvent bits of the last call

  private:
    Vector6d approach(const Vector6d& wanted, double dt) noexcept;

    ForceLimits limits_;
    Vector6d actuator_forces_ = Vector6d::Zero();
    uint32_t events_ = kForceNotLimited;
};

}  // namespace bonemill
