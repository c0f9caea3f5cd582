#include "device_daemon/safety/wrench_limiter.h"

#include <algorithm>

namespace bonemill {

Wrench WrenchLimiter::limit(const Wrench& wanted, double factor, double dt) noexcept {
    events_ = kWrenchNotLimited;
    Wrench target = wanted;
    if (!wanted.isFinite()) {
        events_ |= kWrenchNotFinite;
        target = {};
    }
    const double time = dt > 0 ? dt : 0;  // NaN gives 0, too
    approach(target.force, limits_.max_force_rate * time, before_factor_.force);
    approach(target.torque, limits_.max_torque_rate * time, before_factor_.torque);
    clamp(limits_.max_force, before_factor_.force);
    clamp(limits_.max_torque, before_factor_.torque);
    const double share = factor > 0 ? std::min(factor, 1.0) : 0;
    return {share * before_factor_.force, share * before_factor_.torque};
}

void WrenchLimiter::approach(const Eigen::Vector3d& wanted, double most, Eigen::Vector3d& value) noexcept {
    const Eigen::Vector3d change = wanted - value;
    const double size = change.stableNorm();
    if (size <= most) {
        value = wanted;
        return;
    }
    value += change * (most / size);
    events_ |= kWrenchRateLimited;
}

void WrenchLimiter::clamp(double most, Eigen::Vector3d& value) noexcept {
    const double size = value.stableNorm();
    if (size <= most) return;
    value *= most / size;
    events_ |= kWrenchClamped;
}

}  // namespace bonemill
