// Measures how still shaft and force are held, within seconds that are all contact: a shaft that is turned
// slowly on purpose is no unrest. SI. One normal thread; memory is fixed.
#pragma once

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/motion.h"

namespace bonemill {

class Steadiness {
  public:
    static constexpr int kSamples = int(MotionSample::kRate);  // of a second

    void add(const MotionSample& sample) noexcept;
    void append(Figures& figures) const;

  private:
    void endSecond() noexcept;

    Eigen::Vector3d axes_W_ = Eigen::Vector3d::Zero();
    double force_ = 0, force_squared_ = 0;
    int count_ = 0;
    Distribution axis_unrest_, force_unrest_;  // rad, N
};

}  // namespace bonemill
