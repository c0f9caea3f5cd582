// Where the hand is: whether a sample can be believed, and where between two steps of the encoders the hand
// probably is.
#pragma once

#include <algorithm>
#include <array>

#include "common/device_messages/device_messages.h"
#include "common/geometry/hand_space.h"
#include "haptic_server/core/tick/hand_limits.h"

namespace bonemill {

// Judges whether the hand can be where a sample says. A sample that lies outside of any workspace, or is
// farther from the last one believed than a hand could have gone since, is refused, and the hand counts as
// being where it was. So a single false sample does nothing, and a hand that is taken to another place is
// believed as soon as it could have got there. A device that is late says nothing of its hand: the way it
// could have gone grows meanwhile.
//
// Poses are in V, of the tool. It is RT-safe, for the tick thread only.
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

// Three degrees of freedom of one kind: places, or turns by small angles.
class AxisEstimate {
  public:
    using Vector3d = Eigen::Vector3d;
    struct Body {
        double inertia = 0, damping = 0;
        double step = 0;       // of the encoders; 0: nothing to do
        double stiffness = 0;  // of the coupling that it will swing on
    };
    AxisEstimate() = default;
    AxisEstimate(const Body& body, double amplifier_time, double dt) noexcept;

    bool isIdle() const noexcept { return !(body_.step > 0 && body_.inertia > 0); }
    // So much rides on the device.
    void setHand(double inertia, double damping) noexcept {
        hand_inertia_ = inertia, hand_damping_ = damping;
    }
    void stop() noexcept;
    // Returns the way within a tick in which `earlier` and then, from `change` (0 to 1) on, `later` is
    // commanded.
    Vector3d predict(const Vector3d& earlier, const Vector3d& later, double change) noexcept;
    // Takes how far the reading is from the prediction, and returns how far the estimate goes there.
    Vector3d correct(const Vector3d& innovation) noexcept;
    // Returns how much the estimate may be believed, 1 to 0 where the model foretells badly.
    double trust() const noexcept;

  private:
    void hold(const Vector3d& command, double time, Vector3d& way) noexcept;

    Body body_;
    double surprise_ = 0;                    // steps per tick by which the model was wrong lately
    double speed_gain_ = 0, push_gain_ = 0;  // 1/s, and N/m or N·m/rad
    double hand_inertia_ = 0, hand_damping_ = 0;
    double amplifier_time_ = 0, dt_ = 1e-3;
    Vector3d speed_ = Vector3d::Zero();
    Vector3d drive_ = Vector3d::Zero();  // after the amplifiers
    Vector3d push_ = Vector3d::Zero();   // of all else: the hand, a weight
};

// Says where between two steps of the encoders the hand probably is. Steps of 5 to 50 µm times a stiff spring
// are steps of the force, on which a device without friction would dance for ever.
//
// A reading names an interval, half a step to either side. The estimate goes on by what the device has said
// of its mass and damping, with the wrenches that are acting on it by now and a push of the hand that is
// learnt, and it is drawn back to the interval whenever it leaves it, which also corrects speed and push. So
// it is never farther from the reading than half a step, however wrong the model is: without a hand, in a
// stiff one, or after a lost tick.
//
// Poses and wrenches are in V, torques about the tool point. Poses are the tool's, wrenches those at the
// hand. It is RT-safe, for the tick thread.
class HandEstimate {
  public:
    HandEstimate() = default;
    HandEstimate(const HandleDynamics& handle, const HandSpring& spring, const HandSpace& space,
                 double dt) noexcept;

    bool isIdle() const noexcept { return translation_.isIdle() && rotation_.isIdle(); }
    // Takes the reading of this tick. A device that does not stand alone is taken to be in a typical hand.
    Pose take(const Pose& X_VT_reading, bool stands_alone = true) noexcept;
    // Takes what was sent in this tick, zero if it is not felt.
    void sent(const Wrench& wrench_hand_V) noexcept;

  private:
    static constexpr size_t kRoom = 8;
    const Wrench& commanded(size_t ticks_ago) const noexcept {
        return sent_[(newest_ + kRoom - ticks_ago) % kRoom];
    }

    AxisEstimate translation_, rotation_;
    HandSpace space_;
    double farthest_ = 0;                  // m: from there it starts anew
    size_t delay_ticks_ = 0;               // whole ones
    double delay_rest_ = 0;                // of a tick
    std::array<Wrench, kRoom> sent_ = {};  // a ring
    size_t newest_ = 0;
    Pose X_VT_;
    bool has_pose_ = false;
};

}  // namespace bonemill
