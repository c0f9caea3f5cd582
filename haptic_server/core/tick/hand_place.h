// Judges whether the hand can be where a sample says. A sample that lies outside of any workspace, or is
// farther from the last one believed than a hand could have gone since, is refused, and the hand counts as
// being where it was. So a single false sample does nothing, and a hand that is taken to another place is
// believed as soon as it could have got there. A device that is late says nothing of its hand: the way it
// could have gone grows meanwhile.
//
// Poses are in V, of the tool. It is RT-safe, for the tick thread only.
#pragma once

#include <algorithm>

#include "common/geometry/hand_space.h"

namespace bonemill {

class HandPlace {
  public:
    // m/s and rad/s, of the hand: no hand that mills is so quick, and the daemon stops a handle that flies
    // long before.
    static constexpr double kMostSpeed = 3, kMostSpin = 60;
    static constexpr double kFarthest = 10;     // m from the middle of the bone: no workspace is so large
    static constexpr double kLostAfter = 0.02;  // s without a sample that can be believed

    HandPlace(const Eigen::Vector3d& p_V_middle, const HandSpace& space, double dt) noexcept
        : middle_(p_V_middle),
          farthest_(std::max(kFarthest, space.wayAtTool(kFarthest))),
          most_speed_(space.wayAtTool(kMostSpeed)),
          dt_(dt) {}

    // Takes a tick's sample, a pose; the tick before was `periods` ago. False: it is refused.
    bool take(const Pose& X_VT_sample, int periods) noexcept {
        const bool was_refused = refused_for_ > 0;
        unheard_for_ += dt_ * periods;
        if (!isWithinReach(X_VT_sample)) {
            refused_for_ += dt_ * periods;
            has_jumped_ = false;
            return false;
        }
        has_jumped_ = was_refused || !has_pose_;
        refused_for_ = unheard_for_ = 0;
        has_pose_ = true;
        X_VT_ = X_VT_sample;
        return true;
    }
    // In this tick there was no pose.
    void refuse(int periods) noexcept {
        refused_for_ += dt_ * periods;
        unheard_for_ += dt_ * periods;
        has_jumped_ = false;
    }
    // In this tick there was no new sample. Returns whether the last one was believed.
    bool repeat(int periods) noexcept {
        unheard_for_ += dt_ * periods;
        if (refused_for_ > 0) refused_for_ += dt_ * periods;
        has_jumped_ = false;
        return has_pose_ && refused_for_ == 0;
    }

    // The next sample may be anywhere: the hand was put there.
    void expectAny() noexcept { has_pose_ = false; }

    bool hasPose() const noexcept { return has_pose_; }
    // Tells whether the hand is of a sudden where it is now: its sample is the first that is believed, or the
    // first after others that were not.
    bool hasJumped() const noexcept { return has_jumped_; }
    // Nobody knows any more where the hand is.
    bool isLost() const noexcept { return !has_pose_ || refused_for_ > kLostAfter; }

  private:
    bool isWithinReach(const Pose& X_VT) const noexcept {
        if (!((X_VT.position - middle_).norm() < farthest_)) return false;
        if (!has_pose_) return true;
        const double way = (X_VT.position - X_VT_.position).norm();
        const double turn = logRotation(X_VT.rotation * X_VT_.rotation.conjugate()).norm();
        return way <= most_speed_ * unheard_for_ && turn <= kMostSpin * unheard_for_;
    }

    Eigen::Vector3d middle_;
    double farthest_, most_speed_;  // m and m/s, of the tool
    double dt_;
    Pose X_VT_;               // the last one believed
    double unheard_for_ = 0;  // s since then
    double refused_for_ = 0;  // s since the tick before the first that was refused; 0: the last was believed
    bool has_pose_ = false;
    bool has_jumped_ = false;
};

}  // namespace bonemill
