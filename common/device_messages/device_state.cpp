#include "common/device_messages/device_state.h"

namespace bonemill {
namespace {

// Both lists are in the order of the numbers.
constexpr const char* kStates[kSafetyStateCount] = {
    "disconnected", "connected",       "homing",         "ready", "engaged",
    "paused",       "protective stop", "emergency stop", "fault",
};

struct CauseWords {
    const char* name;
    const char* what_to_do;
};
constexpr CauseWords kCauses[kStopCauseCount] = {
    {"none", ""},
    {"device lost", "Check cable and power of the device."},
    {"implausible pose", "Move the handle to the middle of its workspace and calibrate again."},
    {"pose jumped", "Check the encoders and their cables, and calibrate again."},
    {"position sensor stuck", "Move the handle; if its position stands still, check the encoders."},
    {"too fast", "Hold the handle and reset."},
    {"too much power", "Hold the handle, move the tool out of the bone and reset."},
    {"too much energy", "Hold the handle, move the tool out of the bone and reset."},
    {"force is not what was ordered", "Check motors and amplifiers, then reset."},
    {"near a singularity", "Move the handle back to the middle of its workspace and reset."},
    {"motor too hot", "Let the motors cool down, then reset."},
    {"emergency stop", "Unlock the emergency stop, then reset."},
    {"device fault", "Look up the device's own fault number in its manual, then reset."},
    {"packets come late", "The wire keeps packets back: give the device a network of its own, then reset."},
};
static_assert(kCauses[kStopCauseCount - 1].name && kStates[kSafetyStateCount - 1]);

const CauseWords& wordsOf(StopCause cause) noexcept {
    static constexpr CauseWords kUnknown{"unknown cause", "Restart device_daemon."};
    return uint32_t(cause) < kStopCauseCount ? kCauses[uint32_t(cause)] : kUnknown;
}

}  // namespace

const char* nameOf(SafetyState state) noexcept {
    return uint32_t(state) < kSafetyStateCount ? kStates[uint32_t(state)] : "unknown state";
}

const char* nameOf(StopCause cause) noexcept {
    return wordsOf(cause).name;
}

const char* whatToDo(StopCause cause) noexcept {
    return wordsOf(cause).what_to_do;
}

}  // namespace bonemill
