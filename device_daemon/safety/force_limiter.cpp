#include "device_daemon/safety/force_limiter.h"

#include <algorithm>

namespace bonemill {

void ForceLimiter::take(const Wrench& wrench_hand_D, int64_t stamp_ns) noexcept {
    wrench_hand_D_ = wrench_hand_D;
    stamp_ns_ = stamp_ns;
    has_command_ = true;
}

Vector6d ForceLimiter::forces(const Matrix6d* J_inv, int64_t now_ns, double dt) noexcept {
    events_ = kForceNotLimited;
    Vector6d wanted = wantedForces(J_inv);
    clamp(wanted);
    approach(wanted, dt);
    const double factor = staleFactor(now_ns);
    if (factor == 0) events_ &= ~uint32_t(kForceClamped | kForceRateLimited);  // the motors give nothing
    return factor * before_ramp_;
}

double ForceLimiter::staleFactor(int64_t now_ns) noexcept {
    const bool is_silent = !has_command_ || is_releasing_;
    const int64_t long_ago_ns = now_ns - 2 * stale_.stale_after_ns - 1;
    return ramp_.update(now_ns, is_silent ? long_ago_ns : stamp_ns_);
}

Vector6d ForceLimiter::wantedForces(const Matrix6d* J_inv) noexcept {
    if (J_inv) {
        const Vector6d wanted = actuatorForces(*J_inv, wrench_hand_D_);
        if (wanted.allFinite()) return wanted;
    }
    events_ |= kForceNotFinite;
    return Vector6d::Zero();
}

void ForceLimiter::clamp(Vector6d& forces) noexcept {
    const double largest = forces.cwiseAbs().maxCoeff();
    if (largest <= limits_.max_actuator_force) return;
    forces *= limits_.max_actuator_force / largest;
    events_ |= kForceClamped;
}

void ForceLimiter::approach(const Vector6d& wanted, double dt) noexcept {
    Vector6d change = wanted - before_ramp_;
    const double largest_change = change.cwiseAbs().maxCoeff();
    const double allowed_change = limits_.max_actuator_force_rate * std::max(dt, 0.0);
    if (largest_change > allowed_change) {
        change *= allowed_change / largest_change;
        events_ |= kForceRateLimited;
    }
    before_ramp_ += change;
}

}  // namespace bonemill
