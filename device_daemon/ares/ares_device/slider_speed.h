// Slider velocities for joints that give none: differences of the positions, smoothed.
//
// Steps of 5 um in periods of 1 ms are steps of 5 mm/s; the filter makes 1 mm/s of them, and is 4 ms late. It
// is RT-safe, for one thread. Units are m, s, m/s.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

class SliderSpeed {
  public:
    // Returns the velocities after the positions changed to q in `elapsed`; zero after the first call.
    const Vector6d& update(const Vector6d& q, double elapsed) noexcept {
        if (has_last_ && elapsed > 0) {
            const double share = elapsed / (elapsed + kFilterTime);
            q_dot_ += share * ((q - q_last_) / elapsed - q_dot_);
        }
        q_last_ = q;
        has_last_ = true;
        return q_dot_;
    }

    static constexpr double kFilterTime = 4e-3;  // s

  private:
    Vector6d q_last_ = Vector6d::Zero();
    Vector6d q_dot_ = Vector6d::Zero();
    bool has_last_ = false;
};

}  // namespace bonemill
