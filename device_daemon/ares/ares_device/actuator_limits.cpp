#include "device_daemon/ares/ares_device/actuator_limits.h"

#include <algorithm>
#include <cmath>

namespace bonemill {

LimitedForces limitForces(const Vector6d& base, const Vector6d& wanted, double largest) noexcept {
    if (!base.allFinite() || !wanted.allFinite()) return {.is_finite = false};
    LimitedForces limited;
    limited.base_share = std::min(1.0, largest / std::max(largest, base.cwiseAbs().maxCoeff()));
    const Vector6d kept = limited.base_share * base;
    limited.wanted_share = 1;
    for (int i = 0; i < 6; ++i) {
        const double room = largest - std::copysign(1.0, wanted[i]) * kept[i];
        const double need = std::abs(wanted[i]);
        if (need > room) limited.wanted_share = std::min(limited.wanted_share, std::max(0.0, room / need));
    }
    // Rounding may leave a force one bit beyond.
    limited.forces = (kept + limited.wanted_share * wanted).cwiseMax(-largest).cwiseMin(largest);
    return limited;
}

}  // namespace bonemill
