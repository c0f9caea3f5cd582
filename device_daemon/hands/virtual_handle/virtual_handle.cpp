#include "device_daemon/hands/virtual_handle/virtual_handle.h"

#include <algorithm>
#include <cmath>

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

constexpr double kLongestSubstep = 1e-4;  // s: a small part of what the stiffest wall and the body swing in
constexpr double kRoundingSlack = 1e-6;   // so that 1 ms makes 10 substeps, not 11

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

VirtualHandle::VirtualHandle(const Pose& X_DT_start, const VirtualHand& hand) noexcept
    : hand_(hand),
      damping_(2 * std::sqrt(hand.stiffness * hand.mass)),
      angular_damping_(2 * std::sqrt(hand.angular_stiffness * hand.inertia)),
      motion_(X_DT_start),
      X_DT_(X_DT_start) {}

void VirtualHandle::want(const Pose& X_DT) noexcept {
    motion_.want({bounded(X_DT.position, kReach), X_DT.rotation});
}

void VirtualHandle::place(const Pose& X_DT) noexcept {
    X_DT_ = {bounded(X_DT.position, kReach), X_DT.rotation};
    motion_ = MotionFilter(X_DT_);
    v_DT_.setZero();
    w_DT_.setZero();
}

void VirtualHandle::advance(double elapsed, const Wrench& wrench_D) noexcept {
    if (!(elapsed > 0)) return;
    const double dt = std::min(elapsed, kLongestElapsed);
    const int substeps = static_cast<int>(std::ceil(dt / kLongestSubstep - kRoundingSlack));
    const Wrench push = wrench_D.isFinite() ? wrench_D : Wrench{};
    for (int i = 0; i < substeps; ++i) substep(dt / substeps, push);
}

// Semi-implicit Euler with implicit damping.
void VirtualHandle::substep(double h, const Wrench& wrench_D) noexcept {
    motion_.advance(h);
    const Eigen::Vector3d pull =
        bounded(hand_.stiffness * (motion_.pose().position - X_DT_.position) + damping_ * motion_.v_DT(),
                hand_.max_force);
    v_DT_ = (hand_.mass * v_DT_ + h * (pull + wrench_D.force)) / (hand_.mass + h * damping_);

    const Eigen::Vector3d way = logRotation(motion_.pose().rotation * X_DT_.rotation.conjugate());
    const Eigen::Vector3d twist =
        bounded(hand_.angular_stiffness * way + angular_damping_ * motion_.w_DT(), hand_.max_torque);
    w_DT_ = (hand_.inertia * w_DT_ + h * (twist + wrench_D.torque)) / (hand_.inertia + h * angular_damping_);

    X_DT_ = X_DT_.incremented(h * v_DT_, h * w_DT_);
    if (X_DT_.position.norm() > kReach) {
        X_DT_.position = bounded(X_DT_.position, kReach);
        v_DT_.setZero();
    }
}

DeviceCapabilities handleCapabilities(DeviceKind kind, std::string_view name) noexcept {
    DeviceCapabilities device{};
    name.copy(device.name, sizeof device.name - 1);
    device.kind = static_cast<uint32_t>(kind);
    device.abilities = kAbilityForce | kAbilityTorque | kAbilityOrientation | kAbilitySimulated;
    device.max_force = kMaxHandleForce;
    device.max_torque = kMaxHandleTorque;
    device.max_stiffness = VirtualHandle::kMaxStiffness;
    device.max_rotation_stiffness = VirtualHandle::kMaxRotationStiffness;
    device.workspace_radius = VirtualHandle::kReach;
    return device;
}

Wrench feltWrench(const DeviceOrder& order) noexcept {
    return order.wrench_hand_D.isFinite() ? order.wrench_hand_D : Wrench{};
}

DeviceReading readingOf(const VirtualHandle& handle, const Wrench& felt_D, uint32_t buttons) noexcept {
    return {.X_DT = handle.pose(),
            .v_DT = handle.v_DT(),
            .w_DT = handle.w_DT(),
            .buttons = buttons,
            .status = kStatusPowered | kStatusCalibrated | kStatusDriving,
            .has_applied = true,
            .applied_D = felt_D};
}

}  // namespace bonemill
