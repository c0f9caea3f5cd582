#include "device_daemon/ares/ares_device/sensor_checks.h"

#include <cmath>

namespace bonemill {

void StuckCheck::restart(const Vector6d& q) noexcept {
    speed_ = {};
    q_last_ = q;
    q_when_it_moved_.fill(q);
    was_fast_when_it_moved_.fill(false);
}

bool StuckCheck::isStuck(const Vector6d& q, double elapsed) noexcept {
    const Vector6d& speed = speed_.update(q, elapsed);
    bool is_stuck = false;
    for (int i = 0; i < 6; ++i) {
        if (q[i] != q_last_[i] || standsAtItsStop(q[i])) {
            q_when_it_moved_[i] = q;
            was_fast_when_it_moved_[i] = std::abs(speed[i]) > kDeadStopSpeed && !standsAtItsStop(q[i]);
        }
        const double others_moved = (q - q_when_it_moved_[i]).cwiseAbs().maxCoeff();
        is_stuck = is_stuck || others_moved > (was_fast_when_it_moved_[i] ? kDeadStopTravel : travel_);
    }
    q_last_ = q;
    return is_stuck;
}

bool StuckCheck::standsAtItsStop(double position) const noexcept {
    return position < kStopMargin || position > stroke_ - kStopMargin;
}

bool FrozenCheck::isFrozen(const Vector6d& q, const Eigen::Vector3d& push, double elapsed) noexcept {
    if (!has_last_ || q != q_last_) {
        has_last_ = true;
        q_last_ = q;
        lowest_push_ = highest_push_ = push;
        changed_for_ = pushed_for_ = 0;
        return false;
    }
    lowest_push_ = lowest_push_.cwiseMin(push);
    highest_push_ = highest_push_.cwiseMax(push);
    if ((highest_push_ - lowest_push_).maxCoeff() > least_push_) changed_for_ += elapsed;
    pushed_for_ = push.norm() > least_push_ ? pushed_for_ + elapsed : 0;
    return changed_for_ > kChangedTime || pushed_for_ > kSteadyTime;
}

bool isAtHome(const Vector6d& q, const Vector6d& q_home, double tolerance) noexcept {
    return ((q - q_home).array().abs() <= tolerance).all();
}

}  // namespace bonemill
