// A burr is a few balls and points here, whose distances to a structure stand for the burr's own.
// It is RT-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/pinned_math.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/volume/distance_field.h"

namespace bonemill {

struct BurrProbe {
    Eigen::Vector3d center_T = Eigen::Vector3d::Zero();
    double radius = 0;  // m; 0: a point
};

// A ball is one probe. A cylinder or cone has balls inside of it along the axis, a radius apart (more, if it
// is longer than kMaxBalls radii), and points on both rims.
class BurrProbes {
  public:
    BurrProbes() = default;
    explicit BurrProbes(const Burr& burr) noexcept {
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

    const BurrProbe* begin() const noexcept { return probes_.data(); }
    const BurrProbe* end() const noexcept { return probes_.data() + count_; }
    size_t size() const noexcept { return count_; }

    static constexpr size_t kMinBalls = 5, kMaxBalls = 24, kRim = 8;
    static constexpr size_t kMax = kMaxBalls + 2 * kRim;

  private:
    void add(const BurrProbe& probe) noexcept { probes_[count_++] = probe; }
    void addRim(double y, double radius) noexcept {
        for (size_t n = 0; n < kRim; ++n) {
            const double angle = 2 * M_PI * double(n) / kRim;
            add({Eigen::Vector3d(radius * pinned::cos(angle), y, radius * pinned::sin(angle)), 0});
        }
    }

    std::array<BurrProbe, kMax> probes_;
    size_t count_ = 0;
};

struct NearestStructure {
    double distance;  // m from the burr's surface; the field's reach: nothing within it
    MaterialId material;
};
inline NearestStructure nearestStructure(const DistanceField& field, const BurrProbes& burr,
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
