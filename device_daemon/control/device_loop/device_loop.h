// This is one period of the device loop, without processes, threads or clocks: reading -> DeviceSample, and
// WrenchCommand -> limits and states -> order to the device.
//
// In a period read() comes first, and the sample goes out at once; then write() takes the newest command. The
// command so answers an earlier sample, and the loop has the one tick of delay that a real device has. Time
// comes in as a parameter: the same class runs in device_daemon and in simulated time. It is RT-safe, for one
// thread.
#pragma once

#include "common/device_messages/device_messages.h"
#include "device_daemon/control/device_loop/black_box.h"
#include "device_daemon/control/haptic_device/haptic_device.h"
#include "device_daemon/control/safety/safety_states.h"
#include "device_daemon/control/safety/wrench_limiter.h"

namespace bonemill {

struct DeviceLoopConfig {
    WrenchLimits wrench;  // its norms are lowered to what the device gives
    MotionLimits motion;  // max_force is the device's
    SafetyConfig states;  // its silence is also that of haptic_server
};

class DeviceLoop {
  public:
    // `device` must outlive the loop, which begins in the stop of `latch`. Allocates the black box.
    DeviceLoop(HapticDevice& device, const DeviceLoopConfig& config, const SafetyLatch& latch = {});

    // Reads the device, `elapsed` s after the last period. False says that no pose was ever heard, and there
    // is nothing to publish. A device that has fallen silent shows its last pose, with the stamp of then.
    bool read(int64_t now_ns, double elapsed, DeviceSample& sample) noexcept;

    // Gives the device what it may have of the newest command, or of null if there is none yet. What is not
    // plausible counts as silence.
    void write(const WrenchCommand* newest, int64_t now_ns) noexcept;

    // From now on the server counts as silent, the force ramps to zero, and then the motors are switched off;
    // isReleased() says that the device has been told so.
    void release() noexcept { is_releasing_ = true; }
    bool isReleased() const noexcept { return unwanted_periods_ >= kUnwantedPeriods; }

    uint32_t abilities() const noexcept { return abilities_; }  // DeviceAbility bits of the device
    const SafetyStates& safety() const noexcept { return states_; }
    bool isServerThere() const noexcept { return is_server_there_; }
    // What the hand was given last, in D.
    const Wrench& given() const noexcept { return given_; }
    uint32_t limitEvents() const noexcept { return limiter_.events(); }
    const DeviceReading& reading() const noexcept { return reading_; }
    // Tells how many periods had no reading after the first one.
    uint64_t unheardPeriods() const noexcept { return unheard_periods_; }
    BlackBox& blackBox() noexcept { return black_box_; }

  private:
    static constexpr int kUnwantedPeriods = 10;  // some of these orders may get lost
    // After a pause of the loop (s) force and ramps go on from where they were, not from where they would be.
    static constexpr double kLongestStep = 5e-3;

    void adaptToDevice() noexcept;
    bool takeOrders(const WrenchCommand* newest, int64_t now_ns) noexcept;
    void fill(DeviceSample& sample) const noexcept;
    bool mayDrive() const noexcept;
    void remember(const WrenchCommand* newest, int64_t now_ns) noexcept;

    HapticDevice& device_;
    DeviceLoopConfig config_;
    uint32_t capabilities_version_ = 0;
    uint32_t abilities_ = 0;
    WrenchLimiter limiter_;
    SafetyStates states_;
    BlackBox black_box_;
    DeviceReading reading_;    // the newest that was heard, with the newest fault
    int64_t heard_ns_ = 0;     // then
    bool is_heard_ = false;    // in this period
    bool has_status_ = false;  // the same, of its switches
    double elapsed_ = 0;       // s, of this period
    Wrench commanded_;         // by the newest plausible command
    int64_t command_stamp_ns_ = 0;
    uint32_t reset_orders_ = 0;  // the last number seen
    bool has_command_ = false, is_server_there_ = false, is_releasing_ = false;
    double given_factor_ = 0;
    int unwanted_periods_ = 0;  // since the release left no force
    Wrench given_;
    uint64_t unheard_periods_ = 0;
};

}  // namespace bonemill
