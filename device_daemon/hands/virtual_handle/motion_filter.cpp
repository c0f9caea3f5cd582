#include "device_daemon/hands/virtual_handle/motion_filter.h"

#include <algorithm>

#include "common/geometry/bounded_vector.h"

namespace bonemill {
namespace {

constexpr double kNewestShare = 0.1;  // of an interval in their mean

struct MotionBounds {
    double speed;
    double acceleration;
};

// Where no bound acts this is x'' = k² (wanted - x) - 2 k x', with k = kBandwidth. Braking from the bounded
// speed needs less than the bounded acceleration, so that the bounds make no overshoot.
Eigen::Vector3d nextVelocity(const Eigen::Vector3d& way_left, const Eigen::Vector3d& velocity, double dt,
                             const MotionBounds& bounds) noexcept {
    constexpr double kBandwidth = MotionFilter::kBandwidth;
    const Eigen::Vector3d wanted = bounded(kBandwidth / 2 * way_left, bounds.speed);
    return velocity + dt * bounded(2 * kBandwidth * (wanted - velocity), bounds.acceleration);
}

}  // namespace

void MotionFilter::want(const Pose& X_DT) noexcept {
    X_DT_wanted_ = X_DT;
    // A pause says nothing of how fast wishes come.
    if (since_wish_ < kLongestInterval)
        interval_ += kNewestShare * (std::max(since_wish_, kShortestInterval) - interval_);
    since_wish_ = 0;
    way_time_ = interval_;
}

void MotionFilter::goToWish(double dt) noexcept {
    since_wish_ += dt;
    const double share = way_time_ > dt ? dt / way_time_ : 1;
    way_time_ -= share * way_time_;
    X_DT_way_.position += share * (X_DT_wanted_.position - X_DT_way_.position);
    X_DT_way_.rotation = X_DT_way_.rotation.slerp(share, X_DT_wanted_.rotation).normalized();
}

void MotionFilter::advance(double dt) noexcept {
    static_assert(kBandwidth / 2 * kMaxSpeed < kMaxAcceleration &&
                  kBandwidth / 2 * kMaxSpin < kMaxSpinChange);
    goToWish(dt);
    const Eigen::Vector3d way_left = X_DT_way_.position - X_DT_.position;
    const Eigen::Vector3d turn_left = logRotation(X_DT_way_.rotation * X_DT_.rotation.conjugate());
    v_DT_ = nextVelocity(way_left, v_DT_, dt, {kMaxSpeed, kMaxAcceleration});
    w_DT_ = nextVelocity(turn_left, w_DT_, dt, {kMaxSpin, kMaxSpinChange});
    X_DT_ = X_DT_.incremented(dt * v_DT_, dt * w_DT_);
}

}  // namespace bonemill
