// This is what the device loop needs from a device with six actuators, real or emulated.
//
// One thread (the device loop) calls both functions, readJoints() first, once per loop period each.
// It is RT-safe.
#pragma once

#include <cstdint>

#include "common/geometry/pose.h"

namespace bonemill {

struct JointReading {
    Vector6d q = Vector6d::Zero();  // slider positions from the low end of their stroke, m
    uint32_t buttons = 0;           // bit 0 remove, bit 1 add
};

class JointDevice {
  public:
    virtual ~JointDevice() = default;
    // Returns the joints now. `elapsed` is the time (s) since the last call by the loop's own clock; an
    // emulated device lives through it under the forces applied last.
    virtual JointReading readJoints(double elapsed) noexcept = 0;
    // Puts these forces on the sliders (N, positive along +q), from now until the next call.
    virtual void applyForces(const Vector6d& actuator_forces) noexcept = 0;
};

}  // namespace bonemill
