#include "device_daemon/control/safety/safety_states.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

// The share that a first-order filter of this time takes of the new value in dt.
double shareOf(double dt, double time) noexcept {
    return std::clamp(dt / time, 0.0, 1.0);
}

bool isBroken(StopCause cause) noexcept {
    switch (cause) {
        case StopCause::kImplausiblePose:
        case StopCause::kPoseJump:
        case StopCause::kSensorStuck:
        case StopCause::kForceMismatch:
        case StopCause::kDeviceFault:
            return true;
        default:
            return false;
    }
}

SafetyState stateOf(StopCause cause) noexcept {
    if (cause == StopCause::kEmergencyStop) return SafetyState::kEmergencyStop;
    return isBroken(cause) ? SafetyState::kFault : SafetyState::kProtectiveStop;
}

// What is worse takes over a stop that is there already; its first cause stays.
int severityOf(SafetyState state) noexcept {
    switch (state) {
        case SafetyState::kProtectiveStop:
            return 1;
        case SafetyState::kFault:
            return 2;
        case SafetyState::kEmergencyStop:
            return 3;
        default:
            return 0;
    }
}

}  // namespace

void MotionMonitor::restart() noexcept {
    fast_samples_ = 0;
    power_ = energy_ = mismatched_for_ = 0;
    given_smooth_.setZero();
    applied_smooth_.setZero();
}

StopCause MotionMonitor::check(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    if (isTooFast(reading)) return StopCause::kSpeed;
    if (reading.load >= 1) return StopCause::kOverTemperature;
    if (const StopCause cause = checkPower(reading, given_D, dt); cause != StopCause::kNone) return cause;
    return isMismatched(reading, given_D, dt) ? StopCause::kForceMismatch : StopCause::kNone;
}

bool MotionMonitor::isTooFast(const DeviceReading& reading) noexcept {
    const bool is_fast =
        !(reading.v_DT.norm() <= limits_.max_speed) || !(reading.w_DT.norm() <= limits_.max_angular_speed);
    fast_samples_ = is_fast ? fast_samples_ + 1 : 0;
    return fast_samples_ >= kFastSamples;
}

StopCause MotionMonitor::checkPower(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    const double power = given_D.force.dot(reading.v_DT) + given_D.torque.dot(reading.w_DT);
    if (!std::isfinite(power)) return StopCause::kNone;  // isTooFast() counts such samples
    power_ += shareOf(dt, kPowerTime) * (power - power_);
    energy_ = std::max(0.0, energy_ * (1 - shareOf(dt, kEnergyTime)) + power * dt);
    if (power_ > limits_.max_power) return StopCause::kPower;
    if (energy_ > limits_.max_energy) return StopCause::kEnergy;
    return StopCause::kNone;
}

bool MotionMonitor::isMismatched(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    if (!reading.has_applied) return false;
    const double share = shareOf(dt, kMismatchTime);
    const Eigen::Vector3d ordered = reading.applied_share * given_D.force;
    given_smooth_ += share * (ordered - given_smooth_);
    applied_smooth_ += share * (reading.applied_D.force - applied_smooth_);
    const double allowed = kMismatchShare * given_smooth_.norm() + kMismatchFloor * limits_.max_force;
    const bool differs = !((applied_smooth_ - given_smooth_).norm() <= allowed);
    mismatched_for_ = differs ? mismatched_for_ + dt : 0;
    return mismatched_for_ > kMismatchLasts;
}

double MotionMonitor::warmShare(double load) noexcept {
    if (!(load > kWarmLoad)) return 1;
    const double way = std::min((load - kWarmLoad) / (1 - kWarmLoad), 1.0);
    return 1 - way * (1 - kMinShare);
}

bool SafetyStates::isStopped() const noexcept {
    return severityOf(state_) > 0;
}

SafetyLatch SafetyStates::latch() const noexcept {
    if (!isStopped()) return {.reset_count = reset_count_};
    return {.state = state_, .cause = cause_, .fault_code = fault_code_, .reset_count = reset_count_};
}

void SafetyStates::update(const SafetyInput& input) noexcept {
    const double dt = std::max(input.dt, 0.0);
    has_reset_ = false;
    waits_for_small_wrench_ = false;
    silent_for_ = input.is_heard ? 0 : silent_for_ + dt;
    unwatched_ += dt;
    const StopCause active = causeOf(input);
    if (active != StopCause::kNone) stop(active, input.reading.fault_code);
    if (isStopped())
        takeReset(input, active);
    else
        follow(input);
    if (input.has_status) {
        was_enabled_ = input.reading.status & kStatusEnabled;
        was_reset_pressed_ = input.reading.status & kStatusResetPressed;
        const double step = std::min(dt, kLongestStep) / kWarmTime;
        const double share = MotionMonitor::warmShare(input.reading.load);
        warm_share_ = std::clamp(share, warm_share_ - step, warm_share_ + step);
    }
    moveFactor(input);
}

StopCause SafetyStates::causeOf(const SafetyInput& input) noexcept {
    if (input.has_status && (input.reading.status & kStatusEmergencyStop)) return StopCause::kEmergencyStop;
    if (input.reading.fault != StopCause::kNone) return input.reading.fault;
    if (!input.is_heard) return StopCause::kNone;
    // What was not heard meanwhile has pushed, too.
    const double dt = std::exchange(unwatched_, 0.0);
    if (!(input.reading.status & kStatusDriving)) {  // they push nothing, and what they did is over
        watch_.restart();
        return StopCause::kNone;
    }
    if (state_ == SafetyState::kEngaged) return watch_.check(input.reading, input.given, dt);
    return watch_.checkMotors(input.reading, input.given, dt);
}

void SafetyStates::stop(StopCause cause, uint32_t fault_code) noexcept {
    const SafetyState wanted = stateOf(cause);
    if (!isStopped()) {
        cause_ = cause;
        fault_code_ = fault_code;
    }
    if (severityOf(wanted) > severityOf(state_)) state_ = wanted;
}

void SafetyStates::takeReset(const SafetyInput& input, StopCause active) noexcept {
    const bool is_pressed = input.has_status && (input.reading.status & kStatusResetPressed);
    const bool is_new = input.is_reset_ordered || (is_pressed && !was_reset_pressed_);
    // An emergency stop cannot be reset before its chain is closed. With a closed one the drive may still
    // keep the fault: it is asked to clear it.
    const bool is_chain_open = input.reading.status & kStatusEmergencyStop;
    reset_for_ = is_chain_open ? 0 : is_new ? kResetTime : reset_for_ - input.dt;
    if (reset_for_ <= 0) return;
    asked_for_ = is_new ? kResetEvery : asked_for_ + input.dt;
    if (asked_for_ >= kResetEvery) {
        has_reset_ = true;
        asked_for_ = 0;
    }
    if (active == StopCause::kNone) leaveStop(input.reading);
}

void SafetyStates::leaveStop(const DeviceReading& reading) noexcept {
    ++reset_count_;
    reset_for_ = 0;
    cause_ = StopCause::kNone;
    fault_code_ = 0;
    is_freshly_pressed_ = false;
    state_ = silent_for_ > config_.silence ? SafetyState::kDisconnected : reachedBy(reading);
}

// Without a stop: the device comes, goes, engages and disengages.
void SafetyStates::follow(const SafetyInput& input) noexcept {
    if (silent_for_ > config_.silence) {
        if (state_ == SafetyState::kEngaged || state_ == SafetyState::kPaused)
            cause_ = StopCause::kDeviceLost;
        state_ = SafetyState::kDisconnected;
        is_freshly_pressed_ = false;
        return;
    }
    if (!input.is_heard) return;
    const SafetyState reached = reachedBy(input.reading);
    const bool is_held = !config_.needs_enabling_switch || (input.reading.status & kStatusEnabled);
    if (reached != SafetyState::kReady) {
        state_ = reached;
        is_freshly_pressed_ = false;
    } else if (state_ == SafetyState::kEngaged) {
        if (!is_held || !(input.reading.status & kStatusDriving))
            state_ = SafetyState::kReady;
        else if (!input.is_server_there)
            state_ = SafetyState::kPaused;
        if (state_ != SafetyState::kEngaged) is_freshly_pressed_ = false;
    } else {
        if (state_ != SafetyState::kPaused) state_ = SafetyState::kReady;
        tryToEngage(input);
    }
}

SafetyState SafetyStates::reachedBy(const DeviceReading& reading) const noexcept {
    if (reading.status & kStatusHoming) return SafetyState::kHoming;
    constexpr uint32_t kNeeded = kStatusPowered | kStatusCalibrated;
    return (reading.status & kNeeded) == kNeeded ? SafetyState::kReady : SafetyState::kConnected;
}

void SafetyStates::tryToEngage(const SafetyInput& input) noexcept {
    const bool is_enabled = input.reading.status & kStatusEnabled;
    if (!is_enabled) is_freshly_pressed_ = false;
    if (is_enabled && !was_enabled_ && input.is_server_there) is_freshly_pressed_ = true;
    const bool is_asked = config_.needs_enabling_switch ? is_freshly_pressed_ : true;
    if (!is_asked || !input.is_server_there || !(input.reading.status & kStatusDriving)) return;
    const bool is_small = input.commanded.force.norm() <= config_.engage_force &&
                          input.commanded.torque.norm() <= config_.engage_torque;
    waits_for_small_wrench_ = !is_small;
    if (!is_small) return;
    state_ = SafetyState::kEngaged;
    cause_ = StopCause::kNone;
    watch_.restart();
}

void SafetyStates::moveFactor(const SafetyInput& input) noexcept {
    const double dt = std::max(input.dt, 0.0);
    if (state_ == SafetyState::kEngaged)
        way_ += std::min(dt, kLongestStep) / config_.engage_time;
    else if (state_ == SafetyState::kEmergencyStop)
        way_ = 0;
    else
        way_ -= dt / (isStopped() ? kStopTime : config_.ramp_time);
    way_ = std::clamp(way_, 0.0, 1.0);
    factor_ = way_ * way_ * (3 - 2 * way_);
}

}  // namespace bonemill
