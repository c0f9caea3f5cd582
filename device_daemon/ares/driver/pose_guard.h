// Decides whether the pose that a bridge says may be believed, and remembers why not.
//
// What is no pose at all is refused as long as it is none. After a jump nothing is believed, however well it
// looks, until a user orders a reset or the arm calibrates anew: the same as for ARES (position_guard.h).
// Before calibration the handle may be anywhere, and nothing is a jump. It is RT-safe, for one thread.
#pragma once

#include <cstdint>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"

namespace bonemill {

class PoseGuard {
  public:
    // No hand moves a handle faster. A bridge stamps a pose when it gets it, which may be a fraction of a
    // period late: the slack is for that.
    static constexpr double kLargestSpeed = 5;     // m/s
    static constexpr double kLargestSpin = 60;     // rad/s
    static constexpr double kSlack = 2e-3;         // m
    static constexpr double kAngularSlack = 0.05;  // rad

    // Takes the next pose, read at `stamp_ns` of the bridge's own clock. Of its numbers no more is known than
    // that they are finite; the quaternion may have any length. True says that it may be believed.
    bool take(const Pose& X_DT, int64_t stamp_ns, bool is_calibrated) noexcept;
    // The next pose may be anywhere: it is another session's, and perhaps another clock's. What was refused
    // for a jump stays so.
    void restart() noexcept { has_last_ = false; }
    // Gives the poses another chance, from wherever the handle is now.
    void reset() noexcept;

    // Says why the last pose was refused; kNone where it was believed, and before calibration.
    StopCause cause() const noexcept { return cause_; }

  private:
    bool hasJumped(const Pose& X_DT, int64_t stamp_ns) const noexcept;

    bool has_last_ = false;
    Pose X_DT_;  // the last one that was compared
    int64_t stamp_ns_ = 0;
    bool is_distrusted_ = false;  // until a reset
    StopCause cause_ = StopCause::kNone;
};

}  // namespace bonemill
