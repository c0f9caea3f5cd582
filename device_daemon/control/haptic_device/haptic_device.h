// This is what the device loop needs from any device that a hand can hold: its pose comes in, a wrench goes
// out.
//
// The loop's thread calls waitForSample(), read() and write() in turn; all three are bounded, and neither
// allocate nor lock. Frames and units are those of common/device_messages: D is the device's base, T the
// handle.
#pragma once

#include <cstdint>
#include <string>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"

namespace bonemill {

// The device says this of itself (bit mask).
enum DeviceStatus : uint32_t {
    kStatusPowered = 1u << 0,        // its motors could be switched on
    kStatusCalibrated = 1u << 1,     // its positions count from a zero that it has found
    kStatusHoming = 1u << 2,         // it is finding it
    kStatusDriving = 1u << 3,        // its motors follow what is written
    kStatusEnabled = 1u << 4,        // the enabling switch is held
    kStatusEmergencyStop = 1u << 5,  // the emergency stop chain is open
    kStatusResetPressed = 1u << 6,   // a button to reset is held
    kStatusLeaving = 1u << 7,        // it ends in order, and nothing is wrong
    kStatusScriptEnded = 1u << 8,    // its hand is a scripted one that has done all of its script, and rests
};

struct DeviceReading {
    Pose X_DT;
    Eigen::Vector3d v_DT = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d w_DT = Eigen::Vector3d::Zero();  // rad/s, in D
    uint32_t buttons = 0;                            // Button bits
    uint32_t status = 0;                             // DeviceStatus bits
    StopCause fault = StopCause::kNone;              // what the device, or its driver, complains of
    uint32_t fault_code = 0;                         // the device's own number of it
    bool has_applied = false;                        // the device measures what its motors give
    Wrench applied_D;                                // that, on the hand
    double applied_share = 1;                        // of the order, that the device has its motors give
    double load = 0;                                 // of the hottest motor: 0 cold, 1 as hot as it may get
    uint32_t placements = 0;                         // DeviceSample: of a handle that is only numbers
};

// The loop asks this of the device in every period.
struct DeviceOrder {
    Wrench wrench_hand_D;     // within the device's capabilities; after engagement it ramps to zero
    bool is_wanted = false;   // the motors are to be switched on and to follow, if only with zero
    bool is_engaged = false;  // the hand feels haptic_server
    bool reset = false;       // clear your faults; true for one period
};

class HapticDevice {
  public:
    virtual ~HapticDevice() = default;

    // What the device can do. It may change when another one is plugged in; then the number does, too.
    virtual DeviceCapabilities capabilities() const noexcept = 0;
    virtual uint32_t capabilitiesVersion() const noexcept { return 1; }
    // A literal: what the device says of itself that no device has, so that it counts as silent; else null.
    virtual const char* refusedFigure() const noexcept { return nullptr; }

    // Tells whether the device gives the pace: waitForSample() wakes with each of its samples. Otherwise the
    // loop has its own timer, and does not call waitForSample(). A device that wraps another passes both on.
    virtual bool hasClock() const noexcept { return false; }
    // Sleeps until the device has a new sample, or until the deadline (CLOCK_MONOTONIC ns): true says that
    // there is one.
    virtual bool waitForSample(int64_t) noexcept { return false; }
    // Reads the newest sample, `elapsed` s after the last period. False says that there is none that can be
    // believed: the device is silent, or what it says makes no sense.
    virtual bool read(double elapsed, DeviceReading& reading) noexcept = 0;
    // Holds from now on until the next call.
    virtual void write(const DeviceOrder& order) noexcept = 0;

    // A trainee's attempt begins: a handle that is only numbers stands where the scene begins again. Another
    // thread than the loop's may say so at any time.
    virtual void beginAttempt() noexcept {}

    // The server's run, as viewers know it, is this one: what they ask for in another is old. Another thread
    // than the loop's may say so at any time.
    virtual void followRun(uint64_t) noexcept {}

    // Says why this device must never be used with this scene, and what to do; empty where nothing speaks
    // against it. Another thread than the loop's may ask at any time; it allocates.
    virtual std::string refusal() const { return {}; }
};

}  // namespace bonemill
