#include "haptic_server/tick/energy_tank.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/coupling/loop_fit.h"

namespace bonemill {
namespace {

constexpr double kFillTime = 10;   // s: a tank that is not used fills by itself
constexpr double kWorkTime = 0.1;  // s

double counted(double damping, double inertia, double stiffness) noexcept {
    return std::max(0.0, damping - LoopFit::kDampingRatio * std::sqrt(inertia * stiffness));
}

}  // namespace

void EnergyTank::setDevice(const HandleDynamics& handle, const HandSpring& spring, double scale) noexcept {
    damping_ = counted(handle.damping, handle.mass, spring.stiffness) / scale;
    angular_damping_ = counted(handle.angular_damping, handle.inertia, spring.rotation_stiffness) * scale;
    const double delay = handle.mass > 0 || handle.inertia > 0 ? handle.delay / dt_ : 1;
    delay_ticks_ = size_t(std::clamp(std::lround(delay), 0L, long(kRings - 2)));
    fill();
}

void EnergyTank::add(const Pose& X_VT_device, double stored, const Wrench& wrench_hand_V) noexcept {
    if (has_last_) {
        const Wrench& acted = sent_[(newest_ + kRings - delay_ticks_) % kRings];
        const Eigen::Vector3d way = X_VT_device.position - X_VT_last_.position;
        const Eigen::Vector3d turn = logRotation(X_VT_device.rotation * X_VT_last_.rotation.conjugate());
        const double translation = acted.force.dot(way), rotation = acted.torque.dot(turn);
        const double taken = (damping_ * way.squaredNorm() + angular_damping_ * turn.squaredNorm()) / dt_;
        const double made = stored - stored_last_ + translation + rotation - taken;
        content_ = std::min(content_ - made + kRoom * dt_ / kFillTime, kRoom);
        const double fading = std::max(0.0, 1 - dt_ / kWorkTime);
        translation_work_ = fading * translation_work_ + std::abs(translation);
        rotation_work_ = fading * rotation_work_ + std::abs(rotation);
    }
    X_VT_last_ = X_VT_device;
    stored_last_ = stored;
    newest_ = (newest_ + 1) % kRings;
    sent_[newest_] = wrench_hand_V;
    has_last_ = true;
}

}  // namespace bonemill
