#include "haptic_server/core/tick/energy_tank.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/coupling/loop_fit.h"

namespace bonemill {
namespace {

constexpr double kFillTime = 10;   // s: a tank that is not used fills by itself
constexpr double kWorkTime = 0.1;  // s

double counted(double damping, double inertia, double stiffness) noexcept {
    return std::max(0.0, damping - LoopFit::kDampingRatio * std::sqrt(inertia * stiffness));
}

}  // namespace

void EnergyTank::setDevice(const HandleDynamics& handle, const HandSpring& spring, const HandSpace& space,
                           const Felt& felt) noexcept {
    felt_ = felt;
    damping_ = space.forcePerWayAtTool(
        counted(handle.damping, handle.mass, space.forcePerWayAtHand(spring.stiffness)));
    angular_damping_ =
        space.torqueAtTool(counted(handle.angular_damping, handle.inertia, spring.rotation_stiffness));
    const double delay = handle.mass > 0 || handle.inertia > 0 ? handle.delay / dt_ : 1;
    delay_ticks_ = size_t(std::clamp(std::lround(delay), 0L, long(kRings - 2)));
    fill();
}

double EnergyTank::workOnHand(const PortStep& step) noexcept {
    const Wrench& acted = sent_[(newest_ + kRings - delay_ticks_) % kRings];
    const Wrench& last = sent_[newest_];
    const Eigen::Vector3d way = step.X_VT_device.position - X_VT_last_.position;
    const Eigen::Vector3d turn = logRotation(step.X_VT_device.rotation * X_VT_last_.rotation.conjugate());
    const double translation =
        felt_.force ? acted.force.dot(way) : (last.force + step.wrench_hand_V.force).dot(way) / 2;
    const double rotation =
        felt_.torque ? acted.torque.dot(turn) : (last.torque + step.wrench_hand_V.torque).dot(turn) / 2;
    const double fading = std::max(0.0, 1 - dt_ / kWorkTime);
    translation_work_ = fading * translation_work_ + (felt_.force ? std::abs(translation) : 0);
    rotation_work_ = fading * rotation_work_ + (felt_.torque ? std::abs(rotation) : 0);
    const double taken = (damping_ * way.squaredNorm() + angular_damping_ * turn.squaredNorm()) / dt_;
    return translation + rotation - taken;
}

void EnergyTank::add(const PortStep& step) noexcept {
    if (has_last_) {
        const double made = step.stored - stored_last_ + workOnHand(step) - step.effects_work;
        content_ = std::min(content_ - made + kRoom * dt_ / kFillTime, kRoom);
    } else {
        sent_.fill(step.wrench_hand_V);  // as if it had been this all the time
    }
    X_VT_last_ = step.X_VT_device;
    stored_last_ = step.stored;
    newest_ = (newest_ + 1) % kRings;
    sent_[newest_] = step.wrench_hand_V;
    has_last_ = true;
}

}  // namespace bonemill
