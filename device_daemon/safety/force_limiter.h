// The last stop before the motors has all limits on what the hand feels of a command, in this order.
//
// 1. Finite. A wrench or a Jacobian that is not usable makes no force: the wanted forces are zero. This comes
//    first, because what is not a number can be compared with no limit.
// 2. The clamp: no actuator is asked for more than max_actuator_force. This comes before the rate: where the
//    forces come from and where they go to are then both within the clamp, and with them all that lies
//    between; and from a demand far beyond the clamp they fall from what the motors gave, at once.
// 3. The rate: no actuator's force changes by more than max_actuator_force_rate.
// 4. The stale ramp: a factor that falls to 0 when the server falls silent or the loop is released. It comes
//    last, so that no other limit can undo it: a demand beyond the clamp fades like any other, and at 0 no
//    motor gives anything. The rate does not see it. In all a force changes by no more than the rate and
//    max_actuator_force over the ramp's time (1000 N/s as shipped) together.
//
// Each scales by one factor over all six actuators, so that no limit but the rate turns the wrench's
// direction: the hand then feels too little, not something else. It is RT-safe, for one thread. Units are
// N, N·m, s.
#pragma once

#include "common/ipc/stale_ramp.h"
#include "device_daemon/kinematics/ares_kinematics.h"

namespace bonemill {

struct ForceLimits {
    double max_actuator_force = 50;  // N per actuator
    // It is in N/s per actuator. The steepest honest demand is the coupling's: 3 N/mm at its speed limit of
    // 0.5 m/s is 1500 N/s on the handle, about as much per actuator; this is several times more, and still
    // takes 5 ms to full force.
    double max_actuator_force_rate = 10000;
};

// Says what the limiter did (bit mask).
enum ForceLimitEvent : uint32_t {
    kForceNotLimited = 0,
    kForceNotFinite = 1u << 0,  // the forces go to zero as fast as the rate allows
    kForceRateLimited = 1u << 1,
    kForceClamped = 1u << 2,
};

class ForceLimiter {
  public:
    explicit ForceLimiter(const ForceLimits& limits = {}, const StaleRampConfig& stale = {}) noexcept
        : limits_(limits), stale_(stale), ramp_(stale) {}

    // Takes the newest command: a wrench on the hand, in D about T's origin, and when it was computed.
    void take(const Wrench& wrench_hand_D, int64_t stamp_ns) noexcept;
    // From now on every command counts as silence, and the forces ramp to zero.
    void release() noexcept { is_releasing_ = true; }

    // Called once per period, dt after the last call, it returns the actuator forces for the newest command.
    // J_inv is null without a usable pose. The result is always finite, and never beyond max_actuator_force.
    Vector6d forces(const Matrix6d* J_inv, int64_t now_ns, double dt) noexcept;

    bool isStale() const noexcept { return ramp_.isStale(); }
    bool isReleased() const noexcept { return is_releasing_ && ramp_.factor() == 0; }
    uint32_t events() const noexcept { return events_; }  // ForceLimitEvent bits of the last call

  private:
    double staleFactor(int64_t now_ns) noexcept;
    Vector6d wantedForces(const Matrix6d* J_inv) noexcept;
    void clamp(Vector6d& forces) noexcept;
    void approach(const Vector6d& wanted, double dt) noexcept;

    ForceLimits limits_;
    StaleRampConfig stale_;
    StaleRamp ramp_;
    Wrench wrench_hand_D_;  // of the newest command
    int64_t stamp_ns_ = 0;
    bool has_command_ = false, is_releasing_ = false;
    Vector6d before_ramp_ = Vector6d::Zero();  // what the motors gave, but for the stale ramp
    uint32_t events_ = kForceNotLimited;
};

}  // namespace bonemill
