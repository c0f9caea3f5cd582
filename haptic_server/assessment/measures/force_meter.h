// Measures how hard the trainee presses, and how that and the speed change near protected structures. SI. One
// normal thread; memory is fixed.
#pragma once

#include <array>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/motion.h"
#include "haptic_server/assessment/measures/technique_scene.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

// Of the distance to the nearest protected structure.
class DistanceBins {
  public:
    static constexpr size_t kCount = 4;
    static constexpr std::array<double, kCount - 1> kLimits = {1e-3, 2e-3, 4e-3};  // m
    static constexpr std::array<const char*, kCount> kNames = {"below 1 mm", "1 to 2 mm", "2 to 4 mm",
                                                               "beyond 4 mm"};
    static size_t of(double distance) noexcept {
        size_t bin = 0;
        while (bin < kLimits.size() && !(distance < kLimits[bin])) ++bin;
        return bin;
    }
};

class ForceMeter {
  public:
    explicit ForceMeter(const TechniqueScene& scene)
        : limit_(scene.force_limit), has_structures_(scene.recorded.protection) {}

    void add(const TickStep& step) noexcept;
    void add(const MotionSample& sample) noexcept;  // in the order of time
    void append(Figures& figures) const;

  private:
    double limit_;
    bool has_structures_;
    Distribution in_contact_;
    double impulse_ = 0, excess_ = 0;
    std::array<double, DistanceBins::kCount> excess_at_{};
    std::array<Distribution, DistanceBins::kCount> force_at_, speed_at_;
    MotionSample last_;
};

}  // namespace bonemill
