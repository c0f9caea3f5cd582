#include "device_daemon/control/device_loop/device_loop.h"

#include <algorithm>

namespace bonemill {
namespace {

Eigen::Map<const Eigen::Vector3d> vectorOf(const double (&v)[3]) noexcept {
    return Eigen::Map<const Eigen::Vector3d>(v);
}

void store(const Eigen::Vector3d& vector, double (&out)[3]) noexcept {
    Eigen::Map<Eigen::Vector3d> target(out);
    target = vector;
}

}  // namespace

DeviceLoop::DeviceLoop(HapticDevice& device, const DeviceLoopConfig& config, const SafetyLatch& latch)
    : device_(device),
      config_(config),
      limiter_(config.wrench),
      states_(config.states, config.motion, latch),
      black_box_(latch.cause) {
    adaptToDevice();
}

void DeviceLoop::adaptToDevice() noexcept {
    if (device_.capabilitiesVersion() == capabilities_version_) return;
    capabilities_version_ = device_.capabilitiesVersion();
    const DeviceCapabilities device = device_.capabilities();
    WrenchLimits limits = config_.wrench;
    limits.max_force = std::min(limits.max_force, device.max_force);
    limits.max_torque = std::min(limits.max_torque, device.max_torque);
    limiter_.setLimits(limits);
    MotionLimits motion = config_.motion;
    motion.max_force = device.max_force;
    states_.setMotionLimits(motion);
    abilities_ = device.abilities;
    // A simulated hand without a switch is harmless; every other device needs one, or its user's word.
    const bool hurts_nobody = (abilities_ & kAbilitySimulated) && !(abilities_ & kAbilityEnablingSwitch);
    states_.setNeedsEnablingSwitch(config_.states.needs_enabling_switch && !hurts_nobody);
}

bool DeviceLoop::read(int64_t now_ns, double elapsed, DeviceSample& sample) noexcept {
    elapsed_ = elapsed;
    DeviceReading newest;
    is_heard_ = device_.read(elapsed, newest);
    adaptToDevice();
    if (is_heard_) {
        reading_ = newest;
        heard_ns_ = now_ns;
        has_status_ = true;
    } else {
        reading_.fault = newest.fault;
        reading_.fault_code = newest.fault_code;
        // A device whose pose is refused still says what its switches do; a silent one says nothing.
        has_status_ = newest.status != 0;
        if (has_status_) reading_.status = newest.status;
        if (has_status_) reading_.buttons = newest.buttons;
        reading_.status &= ~uint32_t(kStatusDriving);
        reading_.v_DT.setZero();
        reading_.w_DT.setZero();
        if (heard_ns_ != 0) ++unheard_periods_;
    }
    if (heard_ns_ == 0) return false;
    fill(sample);
    return true;
}

void DeviceLoop::fill(DeviceSample& sample) const noexcept {
    sample = {};
    sample.stamp_ns = heard_ns_;
    store(reading_.X_DT.position, sample.p_DT);
    const Eigen::Quaterniond& q = reading_.X_DT.rotation;
    Eigen::Map<Eigen::Vector4d>(sample.q_DT) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
    store(reading_.v_DT, sample.v_DT);
    store(reading_.w_DT, sample.w_DT);
    sample.buttons = reading_.buttons;
    sample.state = uint32_t(states_.state());
    sample.stop_cause = uint32_t(states_.cause());
    sample.fault_code = states_.faultCode();
    sample.reset_count = states_.resetCount();
    sample.placements = reading_.placements;
    const bool is_simulated = abilities_ & kAbilitySimulated;
    if (is_simulated) sample.flags |= kDeviceFlagSimulated;
    // No person's hand is ever taken for a script.
    if (is_simulated && (reading_.status & kStatusScriptEnded)) sample.flags |= kDeviceFlagScriptEnded;
    if (limiter_.events() != kWrenchNotLimited && given_factor_ > 0) sample.flags |= kDeviceFlagForceLimited;
    if (reading_.status & kStatusEnabled) sample.flags |= kDeviceFlagEnabled;
    if (reading_.status & kStatusCalibrated) sample.flags |= kDeviceFlagCalibrated;
    if (states_.waitsForSmallWrench()) sample.flags |= kDeviceFlagForceWaits;
}

bool DeviceLoop::takeOrders(const WrenchCommand* newest, int64_t now_ns) noexcept {
    if (!newest || !isPlausible(*newest)) newest = nullptr;
    bool is_reset_ordered = false;
    if (newest) {
        // A server that starts anew counts from 0 again: that orders nothing.
        is_reset_ordered = has_command_ && int32_t(newest->reset_orders - reset_orders_) > 0;
        reset_orders_ = newest->reset_orders;
        commanded_ = {vectorOf(newest->f_hand_D), vectorOf(newest->t_hand_D)};
        command_stamp_ns_ = newest->stamp_ns;
        has_command_ = true;
    }
    // Stamps are compared without their difference, which garbage could make overflow.
    const auto silence_ns = int64_t(config_.states.silence * 1e9);
    is_server_there_ = has_command_ && !is_releasing_ && command_stamp_ns_ > now_ns - silence_ns &&
                       command_stamp_ns_ < now_ns + silence_ns;
    return is_reset_ordered;
}

void DeviceLoop::write(const WrenchCommand* newest, int64_t now_ns) noexcept {
    const bool is_reset_ordered = takeOrders(newest, now_ns);
    states_.update({.dt = elapsed_,
                    .is_heard = is_heard_,
                    .has_status = has_status_,
                    .reading = reading_,
                    .is_server_there = is_server_there_,
                    .commanded = commanded_,
                    .given = given_,
                    .is_reset_ordered = is_reset_ordered});
    given_factor_ = states_.factor();
    // What no hand feels must not be where the rate counts from.
    const bool is_felt = states_.state() == SafetyState::kEngaged || given_factor_ > 0;
    given_ = limiter_.limit(is_felt ? commanded_ : Wrench{}, given_factor_, std::min(elapsed_, kLongestStep));
    const SafetyState state = states_.state();
    if (is_releasing_ && given_factor_ == 0) ++unwanted_periods_;
    device_.write({.wrench_hand_D = given_,
                   .is_wanted = has_command_ && unwanted_periods_ == 0 && (given_factor_ > 0 || mayDrive()),
                   .is_engaged = state == SafetyState::kEngaged,
                   .reset = states_.hasReset()});
    remember(newest, now_ns);
}

// What has run away, or is broken, is switched off once the ramp has taken its force.
bool DeviceLoop::mayDrive() const noexcept {
    const SafetyState state = states_.state();
    const StopCause cause = states_.cause();
    const bool ran_away =
        state == SafetyState::kProtectiveStop &&
        (cause == StopCause::kSpeed || cause == StopCause::kPower || cause == StopCause::kEnergy);
    return !ran_away && state != SafetyState::kFault && state != SafetyState::kEmergencyStop;
}

void DeviceLoop::remember(const WrenchCommand* newest, int64_t now_ns) noexcept {
    BlackBoxRecord record{};
    record.time_ns = now_ns;
    fill(record.sample);
    if (newest) record.command = *newest;
    store(given_.force, record.f_given_D);
    store(given_.torque, record.t_given_D);
    record.is_heard = is_heard_;
    black_box_.record(record, states_.cause());
}

}  // namespace bonemill
