#include "device_daemon/bridges/bridge/force_gate.h"

#include <algorithm>

namespace bonemill::bridge {

Wrench ForceGate::step(const std::optional<Wrench>& wanted, double elapsed) noexcept {
    const bool is_allowed = wanted && wanted->isFinite();
    if (is_allowed) held_ = bounded(*wanted, norms_);
    const double change = std::max(0.0, elapsed) / kFadeTime;
    opening_ = std::clamp(opening_ + (is_allowed ? change : -change), 0.0, 1.0);
    if (isClosed()) held_ = {};
    return {held_.force * opening_, held_.torque * opening_};
}

}  // namespace bonemill::bridge
