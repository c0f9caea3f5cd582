#include "device_daemon/bridges/bridge/bridge_link.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "common/rt/clock.h"

namespace bonemill::bridge {
namespace {

constexpr uint32_t kLinkFaults = wire::kFaultWatchdog | wire::kFaultLatePackets;

uint32_t abilitiesOf(const ArmDescription& arm) noexcept {
    return (arm.max_force > 0 ? kAbilityForce : 0u) | (arm.max_torque > 0 ? kAbilityTorque : 0u) |
           (arm.has_orientation ? kAbilityOrientation : 0u);
}

wire::Describe packetOf(const ArmDescription& arm) noexcept {
    wire::Describe packet{};
    packet.firmware = arm.firmware;
    packet.abilities = abilitiesOf(arm);
    packet.serial = arm.serial;
    std::memcpy(packet.name, arm.name.data(), std::min(arm.name.size(), sizeof(packet.name) - 1));
    packet.max_force = arm.max_force;
    packet.max_torque = arm.max_torque;
    packet.max_stiffness = arm.max_stiffness;
    packet.workspace_radius = arm.workspace_radius;
    packet.watchdog_us = wire::kDefaultWatchdogUs;
    packet.rate_hz = uint32_t(kNsPerSecond / kPeriodNs);
    packet.kind = uint32_t(arm.kind);
    return packet;
}

wire::Handle handleOf(const ArmDescription& arm) noexcept {
    const HandleDynamics& handle = arm.handle;
    return {.mass = handle.mass,
            .damping = handle.damping,
            .inertia = handle.inertia,
            .angular_damping = handle.angular_damping,
            .amplifier_time = handle.amplifier_time,
            .delay = handle.delay,
            .encoder_step = handle.encoder_step,
            .encoder_angle = handle.encoder_angle};
}

uint32_t inputsOf(const ArmReading& reading, bool is_leaving) noexcept {
    return wire::kInputChainClosed | (reading.is_enabled ? wire::kInputEnabled : 0u) |
           (reading.is_homed ? wire::kInputHomed : 0u) | (is_leaving ? wire::kInputLeaving : 0u) |
           reading.buttons << wire::kFirstButtonInput;
}

void fillVelocity(wire::PoseState& state, const ArmReading& reading) noexcept {
    const Eigen::Vector3f unknown = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    const bool is_known = reading.has_velocity && reading.v_DT.allFinite() && reading.w_DT.allFinite();
    Eigen::Map<Eigen::Vector3f>(state.v_DT) =
        is_known ? Eigen::Vector3f(reading.v_DT.cast<float>()) : unknown;
    Eigen::Map<Eigen::Vector3f>(state.w_DT) =
        is_known ? Eigen::Vector3f(reading.w_DT.cast<float>()) : unknown;
}

}  // namespace

BridgeLink::BridgeLink(const ArmDescription& arm, const wire::Endpoint& local,
                       const std::optional<wire::Endpoint>& only_host)
    : link_(packetOf(arm), local, only_host, handleOf(arm)), gate_({arm.max_force, arm.max_torque}) {}

ArmOrder BridgeLink::step(const ArmReading& reading, int64_t now_ns) noexcept {
    last_step_ns_ = now_ns;
    link_.poll(now_ns);
    link_.session().step(faultsOf(reading, now_ns),
                         reading.is_powered && reading.is_homed && reading.is_enabled, now_ns);
    const double elapsed = secondsOfNs(before_ns_ == 0 ? 0 : now_ns - before_ns_);
    before_ns_ = now_ns;
    const Wrench wrench_D = gate_.step(wanted(reading, now_ns), elapsed);
    // The state goes out first: the vendor's calls that follow may take their time.
    sendState(reading, now_ns);
    if (shall_leave_ && gate_.isClosed()) has_left_ = true;
    return isDriving(now_ns) ? ArmOrder{wrench_D, true} : ArmOrder{};
}

uint32_t BridgeLink::faultsOf(const ArmReading& reading, int64_t now_ns) noexcept {
    if (good_ns_ == 0 || (reading.is_valid && !reading.has_failed)) good_ns_ = now_ns;
    is_in_trouble_ = now_ns - good_ns_ >= kTroubleNs;
    is_arm_lost_ = now_ns - good_ns_ >= kLostNs;
    fault_code_ = reading.fault_code;
    return reading.faults | (is_in_trouble_ ? wire::kFaultSdk : 0u);
}

// The motors are switched on when the host enables operation, and off when it says so or the arm has failed.
// In between they stay on, also when the host is silent: an arm that still balances its weight does not fall.
bool BridgeLink::isDriving(int64_t now_ns) noexcept {
    const wire::DriveStateMachine& drive = link_.session().drive();
    const uint16_t controlword = link_.session().newestCommand().controlword;
    const bool is_told_off =
        drive.state() == wire::DriveState::kSwitchOnDisabled && controlword == wire::kControlDisable;
    const uint32_t faults = drive.firstFault() | drive.activeFaults();
    const bool has_failed = drive.state() == wire::DriveState::kFault && (faults & ~kLinkFaults) != 0;
    if (drive.state() == wire::DriveState::kOperationEnabled) is_driving_ = true;
    if (!is_told_off) on_ns_ = now_ns;
    const bool is_off = gate_.isClosed() && now_ns - on_ns_ >= kOffAfterNs;
    if (is_off || has_failed) is_driving_ = false;
    return is_driving_;
}

std::optional<Wrench> BridgeLink::wanted(const ArmReading& reading, int64_t now_ns) const noexcept {
    const wire::PoseCommand* command = link_.session().commandInForce(now_ns);
    if (!command || !reading.is_valid || !reading.is_homed || shall_leave_) return std::nullopt;
    const Eigen::Matrix<double, 6, 1> wrench =
        Eigen::Map<const Eigen::Matrix<float, 6, 1>>(command->wrench).cast<double>();
    return Wrench{wrench.head<3>(), wrench.tail<3>()};
}

// A period in which the arm did not say where it is sends nothing, until that is a fault that the host has to
// hear.
void BridgeLink::sendState(const ArmReading& reading, int64_t now_ns) noexcept {
    if (reading.is_valid) X_DT_ = reading.X_DT;
    has_pose_ |= reading.is_valid;
    if (!has_pose_ || (!reading.is_valid && !is_in_trouble_)) return;
    wire::PoseState state{};
    state.inputs = inputsOf(reading, shall_leave_ && gate_.isClosed());
    state.mode = link_.session().newestCommand().mode;
    Eigen::Map<Eigen::Vector3d>(state.p_DT) = X_DT_.position;
    const Eigen::Quaterniond& q = X_DT_.rotation;
    Eigen::Map<Eigen::Vector4d>(state.q_DT) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
    fillVelocity(state, reading);
    state.fault_code = reading.fault_code;
    state.load = float(std::clamp(reading.load, 0.0, 1.0));
    std::fill(std::begin(state.applied), std::end(state.applied), std::numeric_limits<float>::quiet_NaN());
    link_.send(state, now_ns);
}

}  // namespace bonemill::bridge
