#include "device_daemon/hands/virtual_handle/virtual_handle.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/bounded_vector.h"

namespace bonemill {
namespace {

constexpr double kLongestSubstep = 1e-4;  // s: a small part of what the stiffest wall and the body swing in
constexpr double kRoundingSlack = 1e-6;   // so that 1 ms makes 10 substeps, not 11

}  // namespace

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

}  // namespace bonemill
