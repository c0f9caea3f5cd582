// Decides in which state the device is, and how much of the commanded wrench the hand may feel
// (docs/explanation/safety.md has the table of states and causes).
//
// Force flows only while engaged. The device engages when it is calibrated and drives, haptic_server answers,
// the commanded wrench is small, and the enabling switch was pressed afresh and is held (or the user has said
// that there is none). Then the force comes in engage_time. It leaves with the switch (ready), with
// haptic_server (paused), with the device (disconnected), and by any stop, of which the first cause stays
// until a user resets. All ways out take the force with them in ramp_time, or in kStopTime where a limit
// has tripped; an emergency stop takes it at once.
//
// It is RT-safe, for one thread, and pure: time comes in as a parameter. Units are SI.
#pragma once

#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// Watches what handle and motors do to the hand while the device is engaged, and names the first limit that
// is passed: speed, power, energy, a force that is not the one that was ordered, a motor that is too hot.
//
// A wrench in itself is harmless as long as the hand holds against it. What harms is a handle that flies,
// motors that drive the hand on and on, and motors that do not do what they are told. Frames are D.
struct MotionLimits {
    double max_speed = 1;             // m/s
    double max_angular_speed = 26.2;  // rad/s
    double max_power = 10;            // W into the hand, smoothed over kPowerTime
    double max_energy = 3;            // J into the hand, forgotten over kEnergyTime
    double max_force = 50;            // N, of the device: what a mismatch is compared with
};

class MotionMonitor {
  public:
    static constexpr double kPowerTime = 0.02;  // s
    static constexpr double kEnergyTime = 1;    // s
    static constexpr double kMismatchTime =
        0.02;  // s: both forces are smoothed over it, which hides any amplifier's lag
    static constexpr double kMismatchLasts = 0.03;  // s: a mismatch that lasts longer is one
    static constexpr double kMismatchShare = 0.25;  // of the ordered force
    static constexpr double kMismatchFloor = 0.05;  // of the device's largest force
    static constexpr int kFastSamples = 3;          // in a row: one alone may be noise
    // Motors hotter than this get less, down to kMinShare at a load of 1, where the device stops.
    static constexpr double kWarmLoad = 0.8;
    static constexpr double kMinShare = 0.3;

    explicit MotionMonitor(const MotionLimits& limits = {}) noexcept : limits_(limits) {}
    void setLimits(const MotionLimits& limits) noexcept { limits_ = limits; }

    // Forgets what was: the device engages, or its motors are off.
    void restart() noexcept;
    // Called once per period while the device is engaged, with what the device says and what it was given in
    // the period before. Returns the limit that is passed, or kNone.
    StopCause check(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept;

    // The same while it is not engaged: a motor that pushes without being told to has run away.
    StopCause checkMotors(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
        return isMismatched(reading, given_D, dt) ? StopCause::kForceMismatch : StopCause::kNone;
    }

    // Returns the share of the force that motors of this load get.
    static double warmShare(double load) noexcept;

  private:
    bool isTooFast(const DeviceReading& reading) noexcept;
    StopCause checkPower(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept;
    bool isMismatched(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept;

    MotionLimits limits_;
    int fast_samples_ = 0;
    double power_ = 0;
    double energy_ = 0;
    Eigen::Vector3d given_smooth_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d applied_smooth_ = Eigen::Vector3d::Zero();
    double mismatched_for_ = 0;
};

struct SafetyConfig {
    bool needs_enabling_switch = true;
    double engage_force = 1;      // N: the commanded wrench is small up to here
    double engage_torque = 0.02;  // N·m
    double engage_time = 0.3;     // s
    double ramp_time = 0.03;      // s
    double silence = 0.02;        // s without a reading: the device is lost
};

struct SafetyInput {
    double dt = 0;                  // s since the last period
    bool is_heard = false;          // `reading` is new and can be believed
    bool has_status = false;        // its status is new, if not its pose
    DeviceReading reading;          // the newest one; its fault counts also when it cannot be believed
    bool is_server_there = false;   // haptic_server answers
    Wrench commanded;               // by haptic_server, within the limits of the wrench
    Wrench given;                   // to the device in the last period
    bool is_reset_ordered = false;  // by a user, in this period
};

// What a loop leaves to the next one: a stop that has not been reset, if there is one, and the count of
// resets.
struct SafetyLatch {
    SafetyState state = SafetyState::kDisconnected;  // that of a stop, or this one
    StopCause cause = StopCause::kNone;
    uint32_t fault_code = 0;
    uint32_t reset_count = 0;
};

class SafetyStates {
  public:
    static constexpr double kStopTime = 0.01;  // s: short, and still no kick
    // A device needs some periods to clear its own faults: for so long (s) a reset waits, and asks again.
    static constexpr double kResetTime = 0.3;
    static constexpr double kResetEvery = 0.05;
    // The share of hot motors would go from 1 to 0, or back, in this time (s): no motor's heat is quicker,
    // but the flicker of its thermometer is.
    static constexpr double kWarmTime = 1;
    static constexpr double kLongestStep = 5e-3;  // s, of a ramp upwards, after a pause of the loop

    explicit SafetyStates(const SafetyConfig& config = {}, const MotionLimits& limits = {},
                          const SafetyLatch& latch = {}) noexcept
        : config_(config),
          watch_(limits),
          state_(latch.state),
          cause_(latch.cause),
          fault_code_(latch.fault_code),
          reset_count_(latch.reset_count) {}

    void setMotionLimits(const MotionLimits& limits) noexcept { watch_.setLimits(limits); }
    void setNeedsEnablingSwitch(bool is_needed) noexcept { config_.needs_enabling_switch = is_needed; }

    // Called once per period, before what is commanded is written.
    void update(const SafetyInput& input) noexcept;

    SafetyState state() const noexcept { return state_; }
    // The first cause since the last reset; of a lost device until it engages again.
    StopCause cause() const noexcept { return cause_; }
    uint32_t faultCode() const noexcept { return fault_code_; }
    uint32_t resetCount() const noexcept { return reset_count_; }
    SafetyLatch latch() const noexcept;
    // Of the commanded wrench: 0 to 1.
    double factor() const noexcept { return factor_ * warm_share_; }
    // The switch is held and everything is there, but the wrench is not small.
    bool waitsForSmallWrench() const noexcept { return waits_for_small_wrench_; }
    // A reset was taken up in this period: the device shall clear its faults.
    bool hasReset() const noexcept { return has_reset_; }

  private:
    bool isStopped() const noexcept;
    StopCause causeOf(const SafetyInput& input) noexcept;
    void stop(StopCause cause, uint32_t fault_code) noexcept;
    void takeReset(const SafetyInput& input, StopCause active) noexcept;
    void leaveStop(const DeviceReading& reading) noexcept;
    void follow(const SafetyInput& input) noexcept;
    SafetyState reachedBy(const DeviceReading& reading) const noexcept;
    void tryToEngage(const SafetyInput& input) noexcept;
    void moveFactor(const SafetyInput& input) noexcept;

    SafetyConfig config_;
    MotionMonitor watch_;
    SafetyState state_;
    StopCause cause_;
    uint32_t fault_code_;
    uint32_t reset_count_;
    double silent_for_ = 1e9;  // s
    bool was_enabled_ =
        true;  // the switch, in the last period: what is held from the start is not a fresh press
    bool is_freshly_pressed_ = false;
    bool was_reset_pressed_ = true;
    bool waits_for_small_wrench_ = false;
    bool has_reset_ = false;
    double reset_for_ = 0;   // s that a reset still waits
    double asked_for_ = 0;   // s since the device was asked to clear its faults
    double unwatched_ = 0;   // s since the motors were watched last
    double way_ = 0;         // of the ramp, 0 to 1
    double factor_ = 0;      // smooth over it
    double warm_share_ = 1;  // of hot motors
};

}  // namespace bonemill
