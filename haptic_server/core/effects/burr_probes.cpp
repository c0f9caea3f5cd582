#include "haptic_server/core/effects/burr_probes.h"

#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"

namespace bonemill {

BurrProbes::BurrProbes(const Burr& burr) noexcept {
    if (burr.kind == BurrKind::kBall) {
        add({Eigen::Vector3d::Zero(), burr.radius});
        return;
    }
    const double half = burr.length / 2;
    const double radii = burr.length / std::max(burr.radius, 1e-6);
    const auto balls = size_t(std::clamp(std::ceil(radii), double(kMinBalls), double(kMaxBalls)));
    for (size_t n = 0; n < balls; ++n) {
        const double y = half * (2.0 * (double(n) + 0.5) / double(balls) - 1);
        const Eigen::Vector3d center(0, y, 0);
        add({center, std::max(0.0, -burr.signedDistance(center))});
    }
    addRim(half, burr.radius);
    addRim(-half, burr.kind == BurrKind::kCone ? burr.tip_radius : burr.radius);
}

void BurrProbes::addRim(double y, double radius) noexcept {
    for (size_t n = 0; n < kRim; ++n) {
        const double angle = 2 * M_PI * double(n) / kRim;
        add({Eigen::Vector3d(radius * pinned::cos(angle), y, radius * pinned::sin(angle)), 0});
    }
}

NearestStructure nearestStructure(const DistanceField& field, const BurrProbes& burr,
                                  const Pose& X_VT) noexcept {
    NearestStructure nearest{field.reach(), kNoMaterial};
    for (const BurrProbe& probe : burr) {
        const DistanceSample sample = field.at(X_VT * probe.center_T);
        const double distance = sample.distance - probe.radius;
        if (sample.nearest == kNoMaterial || distance >= nearest.distance) continue;
        nearest = {distance, sample.nearest};
    }
    return nearest;
}

}  // namespace bonemill
