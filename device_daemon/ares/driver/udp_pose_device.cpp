#include "device_daemon/ares/driver/udp_pose_device.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "device_daemon/ares/driver/jump_check.h"
#include "device_daemon/ares/driver/udp_device.h"

namespace bonemill {
namespace {

constexpr JumpCheck kMaxWay(PoseGuard::kLargestSpeed, PoseGuard::kSlack);
constexpr JumpCheck kLargestTurn(PoseGuard::kLargestSpin, PoseGuard::kAngularSlack);

bool isPose(const Pose& X_DT) noexcept {
    return X_DT.position.norm() <= kMaxDeviceReach &&
           std::abs(X_DT.rotation.norm() - 1) <= kQuaternionNormTolerance;
}

constexpr double kCutOff_hz = 50;
constexpr int64_t kLongestPauseNs = 100 * kNsPerMillisecond;

Eigen::Vector3d vectorOf(const float* xyz) noexcept {
    return Eigen::Map<const Eigen::Vector3f>(xyz).cast<double>();
}

Pose poseOf(const wire::PoseState& state) noexcept {
    const double* q = state.q_DT;
    return {Eigen::Map<const Eigen::Vector3d>(state.p_DT), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

HandleDynamics handleOf(const wire::Handle& h) noexcept {
    return {.mass = h.mass,
            .damping = h.damping,
            .inertia = h.inertia,
            .angular_damping = h.angular_damping,
            .amplifier_time = h.amplifier_time,
            .delay = h.delay,
            .encoder_step = h.encoder_step,
            .encoder_angle = h.encoder_angle};
}

DeviceCapabilities capabilitiesOf(const wire::Describe& d) noexcept {
    DeviceCapabilities capabilities{};
    static_assert(sizeof(capabilities.name) == sizeof(d.name));
    std::copy(std::begin(d.name), std::end(d.name), capabilities.name);
    capabilities.kind = d.kind;
    capabilities.abilities = d.abilities;
    capabilities.max_force = d.max_force;
    capabilities.max_torque = d.max_torque;
    capabilities.max_stiffness = d.max_stiffness;
    capabilities.max_rotation_stiffness = d.max_rotation_stiffness;
    capabilities.workspace_radius = d.workspace_radius;
    return capabilities;
}

}  // namespace

bool PoseGuard::take(const Pose& X_DT, int64_t stamp_ns, bool is_calibrated) noexcept {
    if (!is_calibrated) {
        reset();
        return isPose(X_DT);
    }
    if (is_distrusted_) return false;
    if (!isPose(X_DT)) {
        cause_ = StopCause::kImplausiblePose;
        return false;
    }
    is_distrusted_ = has_last_ && hasJumped(X_DT, stamp_ns);
    cause_ = is_distrusted_ ? StopCause::kPoseJump : StopCause::kNone;
    has_last_ = true;
    X_DT_ = X_DT;
    stamp_ns_ = stamp_ns;
    return !is_distrusted_;
}

void PoseGuard::reset() noexcept {
    has_last_ = is_distrusted_ = false;
    cause_ = StopCause::kNone;
}

bool PoseGuard::hasJumped(const Pose& X_DT, int64_t stamp_ns) const noexcept {
    const double elapsed = secondsOfNs(nsBetween(stamp_ns_, stamp_ns));
    return kMaxWay.isJump((X_DT.position - X_DT_.position).norm(), elapsed) ||
           kLargestTurn.isJump(X_DT.rotation.angularDistance(X_DT_.rotation), elapsed);
}

void PoseDifferentiator::take(const Pose& X_DT, int64_t stamp_ns) noexcept {
    const int64_t passed_ns = nsBetween(stamp_ns_, stamp_ns);
    if (has_pose_ && passed_ns == 0) return;
    if (!has_pose_ || passed_ns < 0 || passed_ns > kLongestPauseNs) {
        v_DT_.setZero();
        w_DT_.setZero();
    } else {
        const double dt = secondsOfNs(passed_ns);
        const double share = -std::expm1(-kTurn * kCutOff_hz * dt);
        v_DT_ += share * ((X_DT.position - X_DT_.position) / dt - v_DT_);
        w_DT_ += share * (logRotation(X_DT.rotation * X_DT_.rotation.conjugate()) / dt - w_DT_);
    }
    has_pose_ = true;
    X_DT_ = X_DT;
    stamp_ns_ = stamp_ns;
}

DeviceCapabilities UdpPoseDevice::capabilities() const noexcept {
    DeviceCapabilities device = capabilitiesOf(device_.session().description());
    device.handle = handleOf(device_.session().handle());
    if (!isPlausible(device)) device.handle = {};  // what no handle can have is no word of it
    // Who says of himself that he is simulated would be spared the enabling switch.
    device.abilities &= ~uint32_t(kAbilitySimulated);
    return device;
}

bool UdpPoseDevice::read(double, DeviceReading& reading) noexcept {
    reading = {};
    const wire::PoseState* state = device_.read();
    if (device_.isNonsense()) reading.fault = StopCause::kImplausiblePose;
    if (!state) return false;
    reading.buttons = buttonsOf(state->inputs);
    reading.status = device_.status();
    reading.fault = device_.fault();
    reading.fault_code = state->fault_code;
    reading.load = std::clamp(double(state->load), 0.0, 1.0);
    const Pose X_DT = poseOf(*state);
    const bool is_believed = isBelieved(*state, X_DT, reading.status);
    if (reading.fault == StopCause::kNone) reading.fault = guard_.cause();
    if (!is_believed) return false;
    reading.X_DT = {X_DT.position, X_DT.rotation.normalized()};
    readMotion(*state, reading);
    reading.has_applied = std::isfinite(state->applied[0]);
    if (reading.has_applied) reading.applied_D = {vectorOf(state->applied), vectorOf(state->applied + 3)};
    return true;
}

bool UdpPoseDevice::isBelieved(const wire::PoseState& state, const Pose& X_DT, uint32_t status) noexcept {
    if (device_.session().descriptionCount() != guarded_description_) {
        guarded_description_ = device_.session().descriptionCount();
        guard_.restart();
    }
    const bool is_calibrated = (status & kStatusCalibrated) && !(status & kStatusHoming);
    return guard_.take(X_DT, int64_t(state.controller_ns), is_calibrated);
}

void UdpPoseDevice::readMotion(const wire::PoseState& state, DeviceReading& reading) noexcept {
    differentiator_.take(reading.X_DT, int64_t(state.controller_ns));
    const bool has_motion = std::isfinite(state.v_DT[0]);
    reading.v_DT = has_motion ? vectorOf(state.v_DT) : differentiator_.v_DT();
    reading.w_DT = has_motion ? vectorOf(state.w_DT) : differentiator_.w_DT();
}

void UdpPoseDevice::write(const DeviceOrder& order) noexcept {
    if (order.reset) guard_.reset();
    wire::PoseCommand command{};
    if (order.is_wanted) {
        Eigen::Map<Eigen::Vector3f>(command.wrench) = order.wrench_hand_D.force.cast<float>();
        Eigen::Map<Eigen::Vector3f>(command.wrench + 3) = order.wrench_hand_D.torque.cast<float>();
    }
    device_.write(command, {order.is_wanted, order.is_engaged, order.reset});
}

}  // namespace bonemill
