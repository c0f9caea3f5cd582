// The states of the device that hold whatever hand it has, and the causes that stop it.
// docs/explanation/safety.md says what leads from one to another.
//
// The numbers are those in shared memory, on the wire and in the topics: a state or cause keeps its number
// for ever.
#pragma once

#include <cstdint>

namespace bonemill {

enum class SafetyState : uint32_t {
    kDisconnected = 0,    // no device answers
    kConnected = 1,       // it answers, and is not ready to give force: not calibrated, no power, brakes on
    kHoming = 2,          // it finds its zero, and may move by itself
    kReady = 3,           // it could give force, and gives none
    kEngaged = 4,         // the hand feels what haptic_server computes
    kPaused = 5,          // haptic_server is silent: the force has ramped to zero
    kProtectiveStop = 6,  // a limit has tripped
    kEmergencyStop = 7,   // the emergency stop chain is open
    kFault = 8,           // the device or what it says is broken
};
inline constexpr uint32_t kSafetyStateCount = 9;

enum class StopCause : uint32_t {
    kNone = 0,
    kDeviceLost = 1,        // no packet of the device in time
    kImplausiblePose = 2,   // no pose fits what the sensors say, or it is not finite
    kPoseJump = 3,          // it moved farther in one period than any hand can
    kSensorStuck = 4,       // a position stands still that must have moved
    kSpeed = 5,             // the handle is faster than device.max_speed
    kPower = 6,             // the motors drive the hand harder than device.max_power
    kEnergy = 7,            // they gave the hand more than device.max_energy in a second
    kForceMismatch = 8,     // the motors do not give what they were told
    kSingularity = 9,       // the mechanism is about to lose its stiffness
    kOverTemperature = 10,  // a motor is too hot
    kEmergencyStop = 11,
    kDeviceFault = 12,  // the device says so itself; its own number goes along
    kLatePackets = 13,  // too many packets came late
};
inline constexpr uint32_t kStopCauseCount = 14;

// Return names for people, in lower case: "protective stop". Unknown numbers, as a stranger might write them,
// have one, too.
const char* nameOf(SafetyState state) noexcept;
const char* nameOf(StopCause cause) noexcept;
// Says in one sentence what the user has to do about it; empty for kNone.
const char* whatToDo(StopCause cause) noexcept;

}  // namespace bonemill
