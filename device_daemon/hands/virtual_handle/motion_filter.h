// Makes a smooth motion of wishes that come in steps: poses of a mouse or of a slow sensor, 30 to 60 per
// second, become a motion at the loop's rate.
//
// Between two wishes it goes straight, in the mean time that lies between wishes. A critically damped
// follower of second order with bounded speed and acceleration trails that: it does not overshoot, and comes
// to rest at the wish. The frame is D; units are m, rad, s. It is RT-safe, for one thread.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

class MotionFilter {
  public:
    static constexpr double kBandwidth = 60;        // rad/s: it trails by 2 / kBandwidth
    static constexpr double kMaxSpeed = 0.3;        // m/s
    static constexpr double kMaxAcceleration = 20;  // m/s²
    static constexpr double kMaxSpin = 4;           // rad/s
    static constexpr double kMaxSpinChange = 300;   // rad/s²
    static constexpr double kShortestInterval = 0.005, kLongestInterval = 0.06;  // s between wishes

    // Rests at this pose, and wants to stay there.
    explicit MotionFilter(const Pose& X_DT_start) noexcept
        : X_DT_(X_DT_start), X_DT_way_(X_DT_start), X_DT_wanted_(X_DT_start) {}

    void want(const Pose& X_DT) noexcept;
    // Goes on by `dt`, a small part of 1 / kBandwidth.
    void advance(double dt) noexcept;

    const Pose& pose() const noexcept { return X_DT_; }
    const Eigen::Vector3d& v_DT() const noexcept { return v_DT_; }  // m/s
    const Eigen::Vector3d& w_DT() const noexcept { return w_DT_; }  // rad/s, in D

  private:
    void goToWish(double dt) noexcept;

    Pose X_DT_;
    Pose X_DT_way_;  // on the straight way to the wish
    Pose X_DT_wanted_;
    double interval_ = 1.0 / 30;            // s: mean time between wishes
    double since_wish_ = kLongestInterval;  // s
    double way_time_ = 0;                   // s until the way is done
    Eigen::Vector3d v_DT_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT_ = Eigen::Vector3d::Zero();
};

}  // namespace bonemill
