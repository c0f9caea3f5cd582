#include "device_daemon/bridge/common/force_gate.h"

#include <algorithm>

namespace bonemill::bridge {
namespace {

Eigen::Vector3d withNormUpTo(const Eigen::Vector3d& vector, double limit) noexcept {
    const double norm = vector.stableNorm();
    return norm > limit ? Eigen::Vector3d(vector * (limit / norm)) : vector;
}

}  // namespace

Wrench limited(const Wrench& wrench, const WrenchLimits& limits) noexcept {
    if (!wrench.isFinite()) return {};
    return {withNormUpTo(wrench.force, limits.max_force), withNormUpTo(wrench.torque, limits.max_torque)};
}

Wrench ForceGate::step(const std::optional<Wrench>& wanted, double elapsed) noexcept {
    const bool is_allowed = wanted && wanted->isFinite();
    if (is_allowed) held_ = limited(*wanted, limits_);
    const double change = std::max(0.0, elapsed) / kFadeTime;
    opening_ = std::clamp(opening_ + (is_allowed ? change : -change), 0.0, 1.0);
    if (isClosed()) held_ = {};
    return {held_.force * opening_, held_.torque * opening_};
}

}  // namespace bonemill::bridge
