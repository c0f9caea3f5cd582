// This is what a device with six linear actuators gives and takes, real or emulated: the joints of ARES.
//
// One thread calls these functions: waitForSample(), readJoints() and applyForces() in turn, once per loop
// period each. They are RT-safe.
#pragma once

#include <cstdint>

#include "common/geometry/pose.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

struct JointReading {
    Vector6d q = Vector6d::Zero();       // slider positions from the low end of their stroke, m
    Vector6d q_dot = Vector6d::Zero();   // m/s
    Vector6d forces = Vector6d::Zero();  // that the motors give, N
    uint32_t buttons = 0;                // Button bits
    uint32_t status = 0;                 // DeviceStatus bits
    StopCause fault = StopCause::kNone;
    uint32_t fault_code = 0;
    double load = 0;       // of the hottest motor: 0 cold, 1 as hot as it may get
    int64_t taken_ns = 0;  // when q was read, by any clock that runs evenly; 0 if that is not known
};

// It is a DeviceOrder in the joints.
struct JointOrder {
    Vector6d forces = Vector6d::Zero();  // on the sliders, N, positive along +q
    bool is_wanted = false;
    bool is_engaged = false;
    bool reset = false;
};

class JointDevice {
  public:
    virtual ~JointDevice() = default;
    // Both as in HapticDevice.
    virtual bool hasClock() const noexcept { return false; }
    virtual bool waitForSample(int64_t) noexcept { return false; }
    // Reads the joints now. `elapsed` is the time (s) since the last call by the loop's own clock; an
    // emulated device lives through it under the forces applied last. False says that nothing was heard.
    virtual bool readJoints(double elapsed, JointReading& reading) noexcept = 0;
    // Holds from now until the next call.
    virtual void applyForces(const JointOrder& order) noexcept = 0;
};

}  // namespace bonemill
