// Watches what handle and motors do to the hand while the device is engaged, and names the first limit that
// is passed: speed, power, energy, a force that is not the one that was ordered, a motor that is too hot.
//
// A wrench in itself is harmless as long as the hand holds against it. What harms is a handle that flies,
// motors that drive the hand on and on, and motors that do not do what they are told. It is RT-safe, for one
// thread; time comes in as a parameter. Frames are D, units N, N·m, m/s, rad/s, W, J, s.
#pragma once

#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

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
    static constexpr double kMismatchLasts = 0.05;  // s: a mismatch that lasts longer is one
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

}  // namespace bonemill
