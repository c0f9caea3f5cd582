#include "haptic_server/core/tick/hand_pose.h"

#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

// An estimate outside of the interval corrects the speed and the push, slowly against the swing of the device
// on the coupling: quicker ones make the estimate dance on devices without friction.
constexpr double kSpeedGain = 0.3, kPushGain = 0.01, kPushGainOfDamping = 0.02;
// Where the model is wrong by so many steps per tick, lately, the estimate is believed in full and not at
// all: a hand that weighs as much as the device and its own late forces would else keep it swinging.
constexpr double kGoodModel = 0.05, kBadModel = 0.15, kLately = 0.03;  // s
constexpr double kHandMass = 0.1, kHandDamping = 8;                    // kg, N·s/m
constexpr double kFarthestSteps = 100, kMinFarthest = 1e-3;            // m

}  // namespace

AxisEstimate::AxisEstimate(const Body& body, double amplifier_time, double dt) noexcept
    : body_(body), amplifier_time_(amplifier_time), dt_(dt) {
    if (isIdle()) return;
    const double swing = std::min(std::sqrt(body.stiffness / body.inertia), 1 / dt);  // rad/s
    speed_gain_ = kSpeedGain * swing;
    push_gain_ = kPushGain * body.inertia * swing * swing + kPushGainOfDamping * body.damping / dt;
}

void AxisEstimate::stop() noexcept {
    speed_.setZero();
    push_.setZero();
}

// Semi-implicit, in parts that are shorter than the amplifiers' time constant.
void AxisEstimate::hold(const Vector3d& command, double time, Vector3d& way) noexcept {
    constexpr int kParts = 8;
    const double h = time / kParts;
    if (!(h > 0)) return;
    const double inertia = body_.inertia + hand_inertia_, damping = body_.damping + hand_damping_;
    const double settled = amplifier_time_ > 0 ? -pinned::expm1(-h / amplifier_time_) : 1;
    for (int n = 0; n < kParts; ++n) {
        drive_ += settled * (command - drive_);
        const Vector3d before = speed_;
        speed_ = (inertia * speed_ + h * (drive_ + push_)) / (inertia + h * damping);
        way += h / 2 * (before + speed_);
    }
}

Vector3d AxisEstimate::predict(const Vector3d& earlier, const Vector3d& later, double change) noexcept {
    Vector3d way = Vector3d::Zero();
    hold(earlier, change * dt_, way);
    hold(later, (1 - change) * dt_, way);
    return way;
}

Vector3d AxisEstimate::correct(const Vector3d& innovation) noexcept {
    const double half = body_.step / 2;
    const Vector3d correction =
        innovation - innovation.cwiseMin(Vector3d::Constant(half)).cwiseMax(Vector3d::Constant(-half));
    speed_ += speed_gain_ * correction;
    push_ += push_gain_ * correction;
    surprise_ += std::min(dt_ / kLately, 1.0) * (correction.norm() / body_.step - surprise_);
    return correction;
}

double AxisEstimate::trust() const noexcept {
    return std::clamp((kBadModel - surprise_) / (kBadModel - kGoodModel), 0.0, 1.0);
}

// The translation is the tool's; the rotation is the hand's, which the tool shares, with the hand's torque.
HandEstimate::HandEstimate(const HandleDynamics& handle, const HandSpring& spring, const HandSpace& space,
                           double dt) noexcept
    : translation_({space.forcePerWayAtTool(handle.mass), space.forcePerWayAtTool(handle.damping),
                    space.wayAtTool(handle.encoder_step), spring.stiffness},
                   handle.amplifier_time, dt),
      rotation_({handle.inertia, handle.angular_damping, handle.encoder_angle, spring.rotation_stiffness},
                handle.amplifier_time, dt),
      space_(space),
      farthest_(space.wayAtTool(std::max(kFarthestSteps * handle.encoder_step, kMinFarthest))) {
    const double ticks = std::min(handle.delay / dt, double(kRoom - 2));
    delay_ticks_ = size_t(ticks + 1e-9);
    delay_rest_ = std::max(ticks - double(delay_ticks_), 0.0);
}

Pose HandEstimate::take(const Pose& X_VT_reading, bool stands_alone) noexcept {
    if (isIdle()) return X_VT_reading;
    const double way_off = (X_VT_reading.position - X_VT_.position).norm();
    if (!has_pose_ || !(way_off <= farthest_)) {
        has_pose_ = true;
        translation_.stop();
        rotation_.stop();
        X_VT_ = X_VT_reading;
        return X_VT_;
    }
    translation_.setHand(stands_alone ? 0 : space_.forcePerWayAtTool(kHandMass),
                         stands_alone ? 0 : space_.forcePerWayAtTool(kHandDamping));
    // In the period that has just ended the wrench of so many ticks before took over from its predecessor.
    const Wrench &later = commanded(delay_ticks_), &earlier = commanded(delay_ticks_ + 1);
    const Vector3d way = translation_.predict(earlier.force, later.force, delay_rest_);
    const Vector3d turn = rotation_.predict(earlier.torque, later.torque, delay_rest_);
    if (translation_.isIdle()) {
        X_VT_.position = X_VT_reading.position;
    } else {
        X_VT_.position += way;
        X_VT_.position += translation_.correct(X_VT_reading.position - X_VT_.position);
    }
    if (rotation_.isIdle()) {
        X_VT_.rotation = X_VT_reading.rotation;
    } else {
        const Eigen::Quaterniond predicted = expRotation(turn) * X_VT_.rotation;
        const Vector3d off = logRotation(X_VT_reading.rotation * predicted.conjugate());
        X_VT_.rotation = (expRotation(rotation_.correct(off)) * predicted).normalized();
    }
    return {
        X_VT_reading.position + translation_.trust() * (X_VT_.position - X_VT_reading.position),
        (expRotation(rotation_.trust() * logRotation(X_VT_.rotation * X_VT_reading.rotation.conjugate())) *
         X_VT_reading.rotation)
            .normalized()};
}

void HandEstimate::sent(const Wrench& wrench_hand_V) noexcept {
    newest_ = (newest_ + 1) % kRoom;
    sent_[newest_] = wrench_hand_V;
}

}  // namespace bonemill
