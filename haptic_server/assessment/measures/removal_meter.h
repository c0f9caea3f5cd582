// Measures how long, how fast and with which burr bone is removed: voxels that fell below the iso-value. SI.
// One normal thread; memory is fixed.
#pragma once

#include <array>
#include <vector>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/motion.h"
#include "haptic_server/assessment/measures/technique_scene.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

class RemovalMeter {
  public:
    explicit RemovalMeter(const TechniqueScene& scene)
        : scene_(scene), of_(scene.tools.size()), near_of_(scene.tools.size()) {}

    void add(const TickStep& step) noexcept;
    void add(const MotionSample& sample) noexcept;
    double removed() const noexcept { return removed_; }  // m³
    double cutting() const noexcept { return cutting_; }  // s
    void append(Figures& figures) const;

  private:
    static constexpr double kNear = 2e-3;     // m from a structure
    static constexpr double kMinForce = 0.2;  // N: below, the force has no direction that counts
    static constexpr double kSide = 45;       // degrees from the bone's normal: beyond, the side cuts

    void addAngle(const TickStep& step) noexcept;

    TechniqueScene scene_;
    double removed_ = 0, near_removed_ = 0, cutting_ = 0, friction_work_ = 0;
    std::vector<double> of_, near_of_;                      // m³, by tool
    double side_removed_ = 0, removed_with_direction_ = 0;  // m³
    Distribution angle_;                                    // degrees
};

}  // namespace bonemill
