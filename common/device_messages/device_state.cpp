#include "common/device_messages/device_state.h"

namespace bonemill {

const char* nameOf(SafetyState state) noexcept {
    switch (state) {
        case SafetyState::kDisconnected:
            return "disconnected";
        case SafetyState::kConnected:
            return "connected";
        case SafetyState::kHoming:
            return "homing";
        case SafetyState::kReady:
            return "ready";
        case SafetyState::kEngaged:
            return "engaged";
        case SafetyState::kPaused:
            return "paused";
        case SafetyState::kProtectiveStop:
            return "protective stop";
        case SafetyState::kEmergencyStop:
            return "emergency stop";
        case SafetyState::kFault:
            return "fault";
    }
    return "unknown state";
}

const char* nameOf(StopCause cause) noexcept {
    switch (cause) {
        case StopCause::kNone:
            return "none";
        case StopCause::kDeviceLost:
            return "device lost";
        case StopCause::kImplausiblePose:
            return "implausible pose";
        case StopCause::kPoseJump:
            return "pose jumped";
        case StopCause::kSensorStuck:
            return "position sensor stuck";
        case StopCause::kSpeed:
            return "too fast";
        case StopCause::kPower:
            return "too much power";
        case StopCause::kEnergy:
            return "too much energy";
        case StopCause::kForceMismatch:
            return "force is not what was ordered";
        case StopCause::kSingularity:
            return "near a singularity";
        case StopCause::kOverTemperature:
            return "motor too hot";
        case StopCause::kEmergencyStop:
            return "emergency stop";
        case StopCause::kDeviceFault:
            return "device fault";
        case StopCause::kLatePackets:
            return "packets come late";
    }
    return "unknown cause";
}

const char* whatToDo(StopCause cause) noexcept {
    switch (cause) {
        case StopCause::kNone:
            return "";
        case StopCause::kDeviceLost:
            return "Check cable and power of the device.";
        case StopCause::kImplausiblePose:
            return "Move the handle to the middle of its workspace and calibrate again.";
        case StopCause::kPoseJump:
            return "Check the encoders and their cables, and calibrate again.";
        case StopCause::kSensorStuck:
            return "Move the handle; if its position stands still, check the encoders.";
        case StopCause::kSpeed:
            return "Hold the handle and reset.";
        case StopCause::kPower:
        case StopCause::kEnergy:
            return "Hold the handle, move the tool out of the bone and reset.";
        case StopCause::kForceMismatch:
            return "Check motors and amplifiers, then reset.";
        case StopCause::kSingularity:
            return "Move the handle back to the middle of its workspace and reset.";
        case StopCause::kOverTemperature:
            return "Let the motors cool down, then reset.";
        case StopCause::kEmergencyStop:
            return "Unlock the emergency stop, then reset.";
        case StopCause::kDeviceFault:
            return "Look up the device's own fault number in its manual, then reset.";
        case StopCause::kLatePackets:
            return "Give the device a network of its own and check real time, then reset.";
    }
    return "Restart device_daemon.";
}

}  // namespace bonemill
