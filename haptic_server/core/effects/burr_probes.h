// A burr is a few balls and points here, whose distances to a structure stand for the burr's own.
// It is RT-safe.
#pragma once

#include <array>

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
    explicit BurrProbes(const Burr& burr) noexcept;

    const BurrProbe* begin() const noexcept { return probes_.data(); }
    const BurrProbe* end() const noexcept { return probes_.data() + count_; }
    size_t size() const noexcept { return count_; }

    static constexpr size_t kMinBalls = 5, kMaxBalls = 24, kRim = 8;
    static constexpr size_t kMax = kMaxBalls + 2 * kRim;

  private:
    void add(const BurrProbe& probe) noexcept { probes_[count_++] = probe; }
    void addRim(double y, double radius) noexcept;

    std::array<BurrProbe, kMax> probes_;
    size_t count_ = 0;
};

struct NearestStructure {
    double distance;  // m from the burr's surface; the field's reach: nothing within it
    MaterialId material;
};
NearestStructure nearestStructure(const DistanceField& field, const BurrProbes& burr,
                                  const Pose& X_VT) noexcept;

}  // namespace bonemill
