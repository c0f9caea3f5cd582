#include "device_daemon/ares/emulator/emulated_controller.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kSwitchReleasedNs = 50 * kNsPerMillisecond;
constexpr int64_t kSwitchEveryNs = 300 * kNsPerMillisecond;
constexpr int64_t kPatienceNs = 1000 * kNsPerMillisecond;  // with a host that does not engage
constexpr int64_t kResetAfterNs = 500 * kNsPerMillisecond;
constexpr int64_t kResetHeldNs = 50 * kNsPerMillisecond;

constexpr int64_t kHomingNs = 1000 * kNsPerMillisecond;
constexpr double kIdealEncoderStep = 1e-8;  // m, of the counts when the scene has an ideal encoder
constexpr int16_t kWarm_dc = 300;           // 0.1 °C
constexpr int16_t kTooHot_dc = 950;
constexpr uint32_t kBus_mv = 48000;
constexpr double kWorkspaceStep = 1e-3;  // m

// The handle gets so far in each of six directions without turning.
double workspaceRadiusOf(const AresGeometry& geometry) {
    const AresKinematics kinematics(geometry);
    double radius = 0;
    while (radius < geometry.stroke) {
        const double next = radius + kWorkspaceStep;
        for (int i = 0; i < 6; ++i) {
            const Eigen::Vector3d p_DT = (i < 3 ? next : -next) * Eigen::Vector3d::Unit(i % 3);
            if (kinematics.workspaceFaults({p_DT, Eigen::Quaterniond::Identity()}) != kWorkspaceOk)
                return radius;
        }
        radius = next;
    }
    return radius;
}

wire::Describe descriptionOf(const Scenario& scenario, const EmulatedControllerConfig& config) {
    constexpr std::string_view kName = "ARES emulator";
    wire::Describe d{};
    std::copy(kName.begin(), kName.end(), d.name);
    d.firmware = 1;
    d.abilities =
        kAbilityForce | kAbilityTorque | kAbilityOrientation | kAbilityEnablingSwitch | kAbilitySimulated;
    d.max_force = scenario.max_force;
    d.max_torque = scenario.max_torque;
    d.workspace_radius = workspaceRadiusOf(scenario.geometry);
    d.max_actuator_force = scenario.max_actuator_force;
    d.encoder_step = scenario.plant.encoder_step;
    d.stroke = scenario.geometry.stroke;
    d.watchdog_us = config.watchdog_us;
    d.rate_hz = uint32_t(std::lround(config.rate_hz));
    d.kind = uint32_t(DeviceKind::kAres);
    return d;
}

}  // namespace

void HandScript::update(const View& view, int64_t now_ns) noexcept {
    if (!has_begun_) quiet_since_ns_ = now_ns;
    has_begun_ = true;
    pressSwitchAnew(view, now_ns);
    pressResetInTrouble(view, now_ns);
}

void HandScript::pressSwitchAnew(const View& view, int64_t now_ns) noexcept {
    const bool must_press = view.drive == wire::DriveState::kOperationEnabled && !view.is_engaged;
    if (must_press && (!has_pressed_ || now_ns - switch_pressed_ns_ >= kSwitchEveryNs)) {
        switch_pressed_ns_ = now_ns;
        has_pressed_ = true;
    }
    holds_switch_ = has_pressed_ && now_ns - switch_pressed_ns_ >= kSwitchReleasedNs;
}

void HandScript::pressResetInTrouble(const View& view, int64_t now_ns) noexcept {
    const bool is_faulty = view.drive == wire::DriveState::kFault;
    if (view.is_engaged || is_faulty != was_faulty_) quiet_since_ns_ = now_ns;
    was_faulty_ = is_faulty;

    const int64_t patience_ns = is_faulty ? 0 : kPatienceNs;
    const int64_t pressed_for_ns = now_ns - quiet_since_ns_ - patience_ns - kResetAfterNs;
    presses_reset_ = pressed_for_ns >= 0 && pressed_for_ns < kResetHeldNs;
    if (pressed_for_ns >= kResetHeldNs) quiet_since_ns_ = now_ns;  // and wait again
}

EmulatedController::EmulatedController(const Scenario& scenario, const EmulatedControllerConfig& config,
                                       int64_t now_ns)
    : plant_(AresKinematics(scenario.geometry), scenario.plant, scenario.hand, scenario.path),
      encoder_step_(scenario.plant.encoder_step > 0 ? scenario.plant.encoder_step : kIdealEncoderStep),
      faults_(config.faults),
      session_(descriptionOf(scenario, config)),
      lived_until_ns_(now_ns),
      is_homed_(config.is_homed) {
    JointReading reading;
    plant_.readJoints(0, reading);
    power_on_q_ = reading.q;
    if (is_homed_) told_q_ = reading.q;
    plant_.setBraked(true);
}

void EmulatedController::obey(int64_t now_ns) noexcept {
    plant_.advance(std::min(secondsOfNs(now_ns - lived_until_ns_), AresEmulator::kLongestElapsed), forces_);
    lived_until_ns_ = now_ns;

    const wire::JointCommand* command = session_.commandInForce(now_ns);
    plant_.setBraked(command == nullptr);
    forces_.setZero();
    if (command) forces_ = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(command->force).cast<double>();
    for (const FaultSpec& fault : faults_) {
        const bool is_dead =
            fault.kind == FaultKind::kDeadAmplifier && fault.isActive(engagedSeconds(now_ns));
        if (is_dead) forces_[fault.axis] = 0;
    }
}

void EmulatedController::period(int64_t now_ns, wire::JointState& state) noexcept {
    session_.step(deviceFaults(now_ns), !has(FaultKind::kEmergencyStop, now_ns), now_ns);
    obey(now_ns);
    home(now_ns);
    const bool is_engaged = isEngaged(now_ns);
    if (is_engaged && !was_engaged_) {
        was_engaged_ = true;
        first_engaged_ns_ = now_ns;
    }
    if (is_engaged && !is_leaving_ && !is_resting_)
        plant_.startScenario();
    else
        plant_.pauseScenario();
    hand_.update({session_.drive().state(), is_engaged}, now_ns);

    state = {};
    state.inputs = inputs(now_ns);
    const bool is_on = session_.drive().state() == wire::DriveState::kOperationEnabled;
    state.mode = is_on ? session_.newestCommand().mode : uint8_t(wire::kModeNone);
    readEncoders(now_ns, state);
    tellAxes(now_ns, state);
}

void EmulatedController::beginAnew() noexcept {
    is_resting_ = false;
    plant_.beginAnew();
}

bool EmulatedController::isEngaged(int64_t now_ns) const noexcept {
    const wire::JointCommand* command = session_.commandInForce(now_ns);
    return command && (command->flags & wire::kCommandEngaged);
}

double EmulatedController::engagedSeconds(int64_t now_ns) const noexcept {
    return was_engaged_ ? secondsOfNs(now_ns - first_engaged_ns_) : -1;
}

bool EmulatedController::has(FaultKind kind, int64_t now_ns) const noexcept {
    return std::any_of(faults_.begin(), faults_.end(), [&](const FaultSpec& fault) {
        return fault.kind == kind && fault.isActive(engagedSeconds(now_ns));
    });
}

uint32_t EmulatedController::deviceFaults(int64_t now_ns) const noexcept {
    return (has(FaultKind::kEmergencyStop, now_ns) ? uint32_t(wire::kFaultEmergencyStop) : 0u) |
           (has(FaultKind::kOverTemperature, now_ns) ? uint32_t(wire::kFaultOverTemperature) : 0u);
}

void EmulatedController::home(int64_t now_ns) noexcept {
    const bool is_asked = session_.drive().state() == wire::DriveState::kOperationEnabled &&
                          session_.newestCommand().mode == wire::kModeHoming;
    if (is_asked && !is_homing_) homing_since_ns_ = now_ns;
    is_homing_ = is_asked && !is_homed_;
    if (is_homing_ && now_ns - homing_since_ns_ >= kHomingNs) {
        is_homed_ = true;
        is_homing_ = false;
    }
}

uint32_t EmulatedController::inputs(int64_t now_ns) const noexcept {
    uint32_t inputs = plant_.state().target.buttons << wire::kFirstButtonInput;
    if (!has(FaultKind::kEmergencyStop, now_ns)) inputs |= wire::kInputChainClosed;
    if (hand_.holdsEnablingSwitch()) inputs |= wire::kInputEnabled;
    if (hand_.pressesReset()) inputs |= wire::kInputReset;
    if (is_homed_) inputs |= wire::kInputHomed;
    if (is_homing_) inputs |= wire::kInputHoming;
    if (is_leaving_) inputs |= wire::kInputLeaving;
    if (plant_.hasEnded()) inputs |= wire::kInputScriptEnded;
    return inputs;
}

void EmulatedController::readEncoders(int64_t now_ns, wire::JointState& state) noexcept {
    JointReading reading;
    plant_.readJoints(0, reading);
    if (!is_homed_) reading.q -= power_on_q_;  // it counts from where it was switched on
    for (const FaultSpec& fault : faults_) {
        if (!fault.isActive(engagedSeconds(now_ns))) continue;
        if (fault.kind == FaultKind::kEncoderOffset) reading.q[fault.axis] += fault.offset;
        if (fault.kind != FaultKind::kStuckEncoder) continue;
        reading.q[fault.axis] = told_q_[fault.axis];
        reading.q_dot[fault.axis] = 0;
    }
    told_q_ = reading.q;
    Eigen::Map<Vector6d>(state.q) = reading.q;
    Eigen::Map<Eigen::Matrix<float, 6, 1>>(state.qd) = reading.q_dot.cast<float>();
    Eigen::Map<Eigen::Matrix<float, 6, 1>>(state.force) = reading.forces.cast<float>();
    for (int i = 0; i < 6; ++i) state.counts[i] = int32_t(std::lround(reading.q[i] / encoder_step_));
}

void EmulatedController::tellAxes(int64_t now_ns, wire::JointState& state) const noexcept {
    const uint32_t faults = session_.drive().activeFaults();
    std::fill(std::begin(state.axis_status), std::end(state.axis_status), session_.drive().statusword());
    std::fill(std::begin(state.axis_error), std::end(state.axis_error), uint16_t(faults));
    std::fill(std::begin(state.temperature_dc), std::end(state.temperature_dc), kWarm_dc);
    if (has(FaultKind::kOverTemperature, now_ns)) state.temperature_dc[0] = kTooHot_dc;
    state.bus_mv = has(FaultKind::kEmergencyStop, now_ns) ? 0 : kBus_mv;
}

}  // namespace bonemill
