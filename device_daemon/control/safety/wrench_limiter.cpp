#include "device_daemon/control/safety/wrench_limiter.h"

#include <algorithm>

#include "common/geometry/bounded_vector.h"

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
    const bool is_clamped = limitLength(before_factor_.force, limits_.max_force) |
                            limitLength(before_factor_.torque, limits_.max_torque);
    if (is_clamped) events_ |= kWrenchClamped;
    const double share = factor > 0 ? std::min(factor, 1.0) : 0;
    return {share * before_factor_.force, share * before_factor_.torque};
}

void WrenchLimiter::approach(const Eigen::Vector3d& wanted, double most, Eigen::Vector3d& value) noexcept {
    Eigen::Vector3d change = wanted - value;
    if (limitLength(change, most)) {
        value += change;
        events_ |= kWrenchRateLimited;
    } else {
        value = wanted;
    }
}

}  // namespace bonemill
