#include "device_daemon/safety/force_limiter.h"

namespace bonemill {

Vector6d ForceLimiter::limit(const Wrench& wrench, const Matrix6d& J_inv, double dt) noexcept {
    const Vector6d wanted = actuatorForces(J_inv, wrench);
    if (!wanted.allFinite()) return fadeOut(dt);
    events_ = kForceNotLimited;
    return approach(wanted, dt);
}

Vector6d ForceLimiter::fadeOut(double dt) noexcept {
    events_ = kForceNotFinite;
    return approach(Vector6d::Zero(), dt);
}

Vector6d ForceLimiter::approach(const Vector6d& wanted, double dt) noexcept {
    Vector6d change = wanted - actuator_forces_;
    const double largest_change = change.cwiseAbs().maxCoeff();
    const double allowed_change = limits_.max_actuator_force_rate * std::max(dt, 0.0);
    if (largest_change > allowed_change) {
        change *= allowed_change / largest_change;
        events_ |= kForceRateLimited;
    }
    actuator_forces_ += change;

    const double largest_force = actuator_forces_.cwiseAbs().maxCoeff();
    if (largest_force > limits_.max_actuator_force) {
        actuator_forces_ *= limits_.max_actuator_force / largest_force;
        events_ |= kForceClamped;
    }
    return actuator_forces_;
}

}  // namespace bonemill
