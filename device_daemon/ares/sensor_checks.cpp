#include "device_daemon/ares/sensor_checks.h"

#include <algorithm>

namespace bonemill {

bool JumpCheck::jumped(const Vector6d& q, double elapsed) noexcept {
    const double allowed = largest_speed_ * std::max(elapsed, 0.0) + slack_;
    const bool has_jumped = !((q - q_last_).cwiseAbs().maxCoeff() <= allowed);
    q_last_ = q;
    return has_jumped;
}

void StuckCheck::restart(const Vector6d& q) noexcept {
    q_last_ = q;
    q_when_it_moved_.fill(q);
}

bool StuckCheck::isStuck(const Vector6d& q) noexcept {
    bool is_stuck = false;
    for (int joint = 0; joint < 6; ++joint) {
        const bool moved = q[joint] != q_last_[joint];
        if (moved || standsAtItsStop(q[joint])) q_when_it_moved_[joint] = q;
        is_stuck = is_stuck || travelSinceItMoved(q, joint) > travel_;
    }
    q_last_ = q;
    return is_stuck;
}

bool StuckCheck::standsAtItsStop(double position) const noexcept {
    return position < kStopMargin || position > stroke_ - kStopMargin;
}

// Returns how far three of the other five have moved at least. The joint itself has not, so that the third of
// the others is the third of all.
double StuckCheck::travelSinceItMoved(const Vector6d& q, int joint) const noexcept {
    std::array<double, 6> travels;
    for (int i = 0; i < 6; ++i) travels[i] = std::abs(q[i] - q_when_it_moved_[joint][i]);
    std::nth_element(travels.begin(), travels.begin() + 3, travels.end());
    return travels[3];
}

bool FrozenCheck::isFrozen(const Vector6d& q, double push, double elapsed) noexcept {
    const bool stands_still = q == q_last_ && push > least_push_;
    frozen_for_ = stands_still ? frozen_for_ + elapsed : 0;
    q_last_ = q;
    return frozen_for_ > kFrozenTime;
}

bool isAtHome(const Vector6d& q, const Vector6d& q_home, double tolerance) noexcept {
    return (q - q_home).cwiseAbs().maxCoeff() <= tolerance;
}

}  // namespace bonemill
