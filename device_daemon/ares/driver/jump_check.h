// What is farther from where it was than its largest speed allows has not moved there: its sensor has
// slipped, or two of them are mixed up.
//
// It is pure, and RT-safe. Units are m or rad, and s.
#pragma once

#include <algorithm>

namespace bonemill {

class JumpCheck {
  public:
    // `slack` (m or rad) comes on top of what the speed allows: steps of the sensor, and what its clock is
    // off.
    constexpr JumpCheck(double largest_speed, double slack) noexcept
        : largest_speed_(largest_speed), slack_(slack) {}

    // Tells whether nothing gets so far in `elapsed` s. A way that is not a number is a jump.
    constexpr bool isJump(double way, double elapsed) const noexcept {
        return !(way <= largest_speed_ * std::max(elapsed, 0.0) + slack_);
    }

  private:
    double largest_speed_;  // m/s or rad/s
    double slack_;
};

}  // namespace bonemill
