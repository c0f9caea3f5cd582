#include "tests/stability/plant.h"

#include <cmath>
#include <numbers>

namespace bonemill::test {
namespace {

Eigen::Vector3d rounded(const Eigen::Vector3d& v, double step) noexcept {
    return step > 0 ? Eigen::Vector3d((v / step).array().round() * step) : v;
}

// Coulomb friction takes momentum against it, at most all of it.
Eigen::Vector3d afterCoulomb(const Eigen::Vector3d& momentum, double impulse) noexcept {
    const double size = momentum.norm();
    return size > impulse ? Eigen::Vector3d(momentum * (1 - impulse / size)) : Eigen::Vector3d::Zero();
}

}  // namespace

void Plant::advance(double dt, const Wrench& command) noexcept {
    const int substeps = std::max(1, int(std::ceil(dt * kRate_hz - 1e-6)));
    for (int i = 0; i < substeps; ++i) substep(dt / substeps, command);
}

void Plant::substep(double h, const Wrench& command) noexcept {
    const double settled = -std::expm1(-2 * std::numbers::pi * device_.amplifier_hz * h);
    drive_.force += settled * (command.force - drive_.force);
    drive_.torque += settled * (command.torque - drive_.torque);

    target_.position += h * target_velocity_;
    const Pose middle = pose_.incremented(h / 2 * v_, h / 2 * w_);
    const double mass = device_.mass + hand_.mass;
    const Eigen::Vector3d pull = hand_.stiffness * (target_.position - middle.position) +
                                 hand_.damping * target_velocity_ + drive_.force + bias_.force;
    v_ = afterCoulomb(mass * v_ + h * pull, h * device_.coulomb) /
         (mass + h * (device_.damping + hand_.damping));

    const double inertia = device_.inertia + hand_.inertia;
    const Eigen::Vector3d twist =
        hand_.angular_stiffness * logRotation(target_.rotation * middle.rotation.conjugate()) +
        drive_.torque + bias_.torque;
    w_ = afterCoulomb(inertia * w_ + h * twist, h * device_.angular_coulomb) /
         (inertia + h * (device_.angular_damping + hand_.angular_damping));
    pose_ = middle.incremented(h / 2 * v_, h / 2 * w_);
}

Pose Plant::measured() const noexcept {
    const Eigen::Vector3d turn = logRotation(pose_.rotation * zero_.rotation.conjugate());
    return {rounded(pose_.position, device_.encoder_step),
            (expRotation(rounded(turn, device_.encoder_angle)) * zero_.rotation).normalized()};
}

double Plant::energy() const noexcept {
    const double kinetic = (device_.mass + hand_.mass) * v_.squaredNorm() / 2 +
                           (device_.inertia + hand_.inertia) * w_.squaredNorm() / 2;
    const Eigen::Vector3d turn = logRotation(target_.rotation * pose_.rotation.conjugate());
    return kinetic + hand_.stiffness * (target_.position - pose_.position).squaredNorm() / 2 +
           hand_.angular_stiffness * turn.squaredNorm() / 2;
}

}  // namespace bonemill::test
