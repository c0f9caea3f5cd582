#include "device_daemon/ares/driver/udp_device.h"

#include <algorithm>

#include "common/rt/clock.h"
#include "device_daemon/ares/wire/drive_state.h"

namespace bonemill {
namespace {

// A motor is as warm as a room at load 0, and at 1 as hot as a touched housing may make its windings.
constexpr double kColdMotor_dc = 200;  // 0.1 °C
constexpr double kHotMotor_dc = 800;

double loadOf(const int16_t (&temperature_dc)[6]) noexcept {
    const double hottest_dc = *std::max_element(temperature_dc, temperature_dc + 6);
    return std::clamp((hottest_dc - kColdMotor_dc) / (kHotMotor_dc - kColdMotor_dc), 0.0, 1.0);
}

constexpr uint16_t kVoltageEnabledBit = 1u << 4;

constexpr uint32_t kPassingFaults =
    wire::kFaultOverTemperature | wire::kFaultOverSpeed | wire::kFaultWatchdog | wire::kFaultLatePackets;

// The first one that is there counts, and the gravest comes first: what is broken, and what no user has given
// a name, before what passes.
constexpr std::pair<uint32_t, StopCause> kCauses[] = {
    {wire::kFaultEmergencyStop, StopCause::kEmergencyStop},
    {~kPassingFaults, StopCause::kDeviceFault},
    {wire::kFaultOverTemperature, StopCause::kOverTemperature},
    {wire::kFaultOverSpeed, StopCause::kSpeed},
    {wire::kFaultWatchdog, StopCause::kDeviceLost},
    {wire::kFaultLatePackets, StopCause::kLatePackets},
};

// An order to reset is said so often, because packets get lost. The controller acts on the first that comes.
constexpr int kResetRepeats = 10;

// `is_trusted`: the link has proved itself; before that nothing is powered.
uint32_t deviceStatusOf(uint32_t inputs, uint16_t statusword, bool is_trusted) noexcept {
    const bool has_voltage = (statusword & kVoltageEnabledBit) && !(inputs & wire::kInputBrake);
    const bool is_driving = wire::driveStateOf(statusword) == wire::DriveState::kOperationEnabled;
    uint32_t status = 0;
    if (is_trusted && has_voltage) status |= kStatusPowered;
    if (is_trusted && is_driving) status |= kStatusDriving;
    if (inputs & wire::kInputHomed) status |= kStatusCalibrated;
    if (inputs & wire::kInputHoming) status |= kStatusHoming;
    if (inputs & wire::kInputEnabled) status |= kStatusEnabled;
    if (!(inputs & wire::kInputChainClosed)) status |= kStatusEmergencyStop;
    if (inputs & wire::kInputReset) status |= kStatusResetPressed;
    if (inputs & wire::kInputLeaving) status |= kStatusLeaving;
    if (inputs & wire::kInputScriptEnded) status |= kStatusScriptEnded;
    return status;
}

StopCause stopCauseOf(uint32_t faults) noexcept {
    for (const auto& [bits, cause] : kCauses) {
        if (faults & bits) return cause;
    }
    return StopCause::kNone;
}

}  // namespace

bool UdpJointDevice::readJoints(double, JointReading& reading) noexcept {
    const wire::JointState* state = device_.read();
    if (device_.isNonsense()) reading.fault = StopCause::kImplausiblePose;
    if (!state) return false;
    reading.q = Eigen::Map<const Vector6d>(state->q);
    reading.q_dot = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(state->qd).cast<double>();
    reading.forces = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(state->force).cast<double>();
    reading.buttons = buttonsOf(state->inputs);
    reading.status = device_.status();
    reading.fault = device_.fault();
    reading.fault_code = state->first_fault;
    reading.load = loadOf(state->temperature_dc);
    reading.taken_ns = int64_t(state->controller_ns);
    return true;
}

void UdpJointDevice::applyForces(const JointOrder& order) noexcept {
    wire::JointCommand command{};
    if (order.is_wanted) {
        Eigen::Map<Eigen::Matrix<float, 6, 1>>(command.force) = order.forces.cast<float>();
    }
    device_.write(command, {order.is_wanted, order.is_engaged, order.reset});
}

const wire::Describe* UdpJointDevice::description() const noexcept {
    return descriptionCount() > 0 ? &device_.session().description() : nullptr;
}

uint32_t buttonsOf(uint32_t inputs) noexcept {
    return (inputs >> wire::kFirstButtonInput) & (kButtonRemove | kButtonAdd);
}

template <class Packets>
auto UdpDevice<Packets>::read() noexcept -> const State* {
    const int64_t now_ns = monotonicNowNs();
    link_.poll(now_ns);
    told_fault_ = std::exchange(newest_fault_, session().state().first_fault);
    is_nonsense_ = std::exchange(told_nonsense_, session().nonsenseCount()) != session().nonsenseCount();
    const bool is_there = session().hasState() && !session().isLost(now_ns);
    return is_there && !is_nonsense_ ? &session().state() : nullptr;
}

template <class Packets>
uint32_t UdpDevice<Packets>::status() const noexcept {
    const State& state = session().state();
    return deviceStatusOf(state.inputs, state.statusword, session().isTrusted());
}

template <class Packets>
StopCause UdpDevice<Packets>::fault() const noexcept {
    const State& state = session().state();
    if (newest_fault_ != 0 && newest_fault_ != told_fault_) return stopCauseOf(newest_fault_);
    uint32_t faults = state.first_fault | state.active_faults;
    const bool has_fault = wire::driveStateOf(state.statusword) == wire::DriveState::kFault;
    if (has_fault && faults == 0) faults = wire::kFaultInternal;
    if (session().tooManyLate()) faults |= wire::kFaultLatePackets;
    return stopCauseOf(faults);
}

template <class Packets>
void UdpDevice<Packets>::write(Command& command, const Wish& wish) noexcept {
    const State& state = session().state();
    const bool must_home = wish.is_wanted && !(state.inputs & wire::kInputHomed);
    command.flags = wish.is_engaged ? wire::kCommandEngaged | wire::kCommandAttached : 0;
    command.controlword = controlword(wish);
    command.mode = must_home ? wire::kModeHoming : wire::kModeTorque;
    command.enabling_echo = state.inputs & wire::kInputEnabled;
    link_.send(command, monotonicNowNs());
}

template <class Packets>
uint16_t UdpDevice<Packets>::controlword(const Wish& wish) noexcept {
    const wire::DriveState state = wire::driveStateOf(session().state().statusword);
    // What has not gone yet is not reset: whoever wants it asks again.
    const bool is_over = state == wire::DriveState::kFault && session().state().active_faults == 0;
    if (wish.reset) resets_left_ = kResetRepeats;
    if (!is_over) resets_left_ = 0;
    if (resets_left_ > 0) {
        --resets_left_;
        return wire::kControlFaultReset;
    }
    return wire::controlwordTowards(wish.is_wanted && session().isTrusted(), state);
}

template class UdpDevice<wire::JointPackets>;
template class UdpDevice<wire::PosePackets>;

}  // namespace bonemill
