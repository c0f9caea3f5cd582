#include "device_daemon/ares/driver/udp_pose_device.h"

#include <algorithm>
#include <cmath>

#include "device_daemon/ares/driver/wire_status.h"

namespace bonemill {
namespace {

Eigen::Vector3d vectorOf(const float* xyz) noexcept {
    return Eigen::Map<const Eigen::Vector3f>(xyz).cast<double>();
}

Pose poseOf(const wire::PoseState& state) noexcept {
    const double* q = state.q_DT;
    return {Eigen::Map<const Eigen::Vector3d>(state.p_DT), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

}  // namespace

DeviceCapabilities UdpPoseDevice::capabilities() const noexcept {
    DeviceCapabilities device = capabilitiesOf(device_.session().description());
    // Who says of himself that he is simulated would be spared the enabling switch.
    device.abilities &= ~uint32_t(kAbilitySimulated);
    return device;
}

bool UdpPoseDevice::read(double, DeviceReading& reading) noexcept {
    reading = {};
    const wire::PoseState* state = device_.read();
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
