#include "device_daemon/ares/ares_device/ares_device.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/ares_kinematics/ares_kinematics.h"

namespace bonemill {
namespace {

// As the force that comes in when the device engages, and the one that goes when the server falls silent.
constexpr double kWallsFadeIn = 0.3;    // s
constexpr double kWallsFadeOut = 0.03;  // s

DeviceCapabilities capabilitiesOf(const AresDeviceConfig& config) {
    DeviceCapabilities capabilities{};
    std::snprintf(capabilities.name, sizeof capabilities.name, "%s (placeholder geometry)",
                  config.is_simulated ? "ARES emulator" : "ARES");
    capabilities.kind = static_cast<uint32_t>(DeviceKind::kAres);
    capabilities.abilities = kAbilityForce | kAbilityTorque | kAbilityOrientation;
    if (config.is_simulated) capabilities.abilities |= kAbilitySimulated;
    if (config.has_enabling_switch) capabilities.abilities |= kAbilityEnablingSwitch;
    capabilities.max_force = config.max_force;
    capabilities.max_torque = config.max_torque;
    capabilities.handle = config.handle;
    capabilities.workspace_radius = reachRadius(AresKinematics(config.geometry), kSpecifiedTurn);
    return capabilities;
}

}  // namespace

LimitedForces limitForces(const Vector6d& base, const Vector6d& wanted, double largest) noexcept {
    if (!base.allFinite() || !wanted.allFinite()) return {.is_finite = false};
    LimitedForces limited;
    limited.base_share = std::min(1.0, largest / std::max(largest, base.cwiseAbs().maxCoeff()));
    const Vector6d kept = limited.base_share * base;
    limited.wanted_share = 1;
    for (int i = 0; i < 6; ++i) {
        const double room = largest - std::copysign(1.0, wanted[i]) * kept[i];
        const double need = std::abs(wanted[i]);
        if (need > room) limited.wanted_share = std::min(limited.wanted_share, std::max(0.0, room / need));
    }
    // Rounding may leave a force one bit beyond.
    limited.forces = (kept + limited.wanted_share * wanted).cwiseMax(-largest).cwiseMin(largest);
    return limited;
}

Wrench holdingWrench(const MovingWeight& weight, const Pose& X_DT) noexcept {
    const Eigen::Vector3d force = -weight.mass * kStandardGravity * weight.down_D;
    return {force, (X_DT.rotation * weight.centre_T).cross(force)};
}

AresDevice::AresDevice(JointDevice& joints, const AresDeviceConfig& config) noexcept
    : joints_(joints),
      config_(config),
      guard_(AresKinematics(config.geometry), config.guard),
      walls_(AresKinematics(config.geometry), config.walls),
      capabilities_(capabilitiesOf(config)),
      X_DT_(config.guard.home ? config.guard.home->X_DT : config.guard.X_DT_start) {}

bool AresDevice::read(double elapsed, DeviceReading& reading) noexcept {
    reading = {};
    elapsed_ = elapsed;
    since_heard_ += elapsed;
    has_pose_ = false;
    JointReading joints;
    if (!joints_.readJoints(elapsed, joints)) {
        reading.fault = joints.fault;
        return false;
    }
    reading.buttons = joints.buttons;
    reading.status = joints.status;
    reading.fault = joints.fault;
    reading.fault_code = joints.fault_code;
    reading.load = joints.load;

    has_pose_ = guard_.take(joints, sent_.push, since_heard_);
    since_heard_ = 0;
    if (!guard_.isCalibrated()) reading.status &= ~uint32_t(kStatusCalibrated);
    if (reading.fault == StopCause::kNone) reading.fault = guard_.cause();
    if (reading.fault == StopCause::kNone && was_not_finite_) {
        reading.fault = StopCause::kDeviceFault;
        reading.fault_code = kAresNotFinite;
    }
    if (has_pose_) {
        const Location& location = guard_.location();
        X_DT_ = location.X_DT;
        twist_D_ = location.J_inv.partialPivLu().solve(guard_.sliderSpeed());
        holding_ = ::bonemill::actuatorForces(location.J_inv, holdingWrench(config_.weight, X_DT_));
    } else if (guard_.cause() == StopCause::kNone || !isFinite(joints)) {
        holding_.setZero();  // uncalibrated, or not a number: nothing is known of the pose
    }
    fillPose(joints, reading);
    return guard_.cause() == StopCause::kNone;
}

void AresDevice::fillPose(const JointReading& joints, DeviceReading& reading) const noexcept {
    reading.X_DT = X_DT_;
    if (!has_pose_) return;
    reading.v_DT = twist_D_.head<3>();
    reading.w_DT = twist_D_.tail<3>();
    reading.has_applied = true;
    reading.applied_share = wrench_share_;
    reading.applied_D = wrenchOf(guard_.location().J_inv, joints.forces - sent_.base);
}

void AresDevice::write(const DeviceOrder& order) noexcept {
    if (order.reset) guard_.reset();
    fadeWalls(order.is_wanted && order.is_engaged && has_pose_);
    touches_wall_ = false;
    wrench_share_ = 0;
    was_not_finite_ = false;
    sent_ = order.is_wanted ? compose(order) : Sent{};
    joints_.applyForces({.forces = sent_.forces,
                         .is_wanted = order.is_wanted,
                         .is_engaged = order.is_engaged,
                         .reset = order.reset});
}

AresDevice::Sent AresDevice::compose(const DeviceOrder& order) noexcept {
    const Vector6d base = holding_ + wallForces();
    Vector6d wanted = Vector6d::Zero();
    if (has_pose_) wanted = ::bonemill::actuatorForces(guard_.location().J_inv, order.wrench_hand_D);
    const LimitedForces limited = limitForces(base, wanted, config_.max_actuator_force);
    was_not_finite_ = !limited.is_finite || !order.wrench_hand_D.isFinite();
    if (was_not_finite_) return {};
    wrench_share_ = has_pose_ ? limited.wanted_share : 0;
    return {.forces = limited.forces,
            .base = limited.base_share * base,
            .push = wrench_share_ * order.wrench_hand_D.force};
}

void AresDevice::fadeWalls(bool is_engaged) noexcept {
    const double change = is_engaged ? elapsed_ / kWallsFadeIn : -elapsed_ / kWallsFadeOut;
    walls_share_ = std::clamp(walls_share_ + change, 0.0, 1.0);
}

Vector6d AresDevice::wallForces() noexcept {
    if (!has_pose_ || walls_share_ == 0) return Vector6d::Zero();
    const Matrix6d& J_inv = guard_.location().J_inv;
    const WallReaction reaction = walls_.at(X_DT_, J_inv, twist_D_);
    touches_wall_ = reaction.touches;
    return walls_share_ * ::bonemill::actuatorForces(J_inv, reaction.wrench_D);
}

}  // namespace bonemill
