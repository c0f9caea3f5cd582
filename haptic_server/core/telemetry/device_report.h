// This is what a tick knew of its device besides where it is and what is pressed.
#pragma once

#include <cstdint>

#include "common/device_messages/device_messages.h"

namespace bonemill {

// A tick that runs without a device, from a file for instance, takes it for engaged. The numbers are those of
// the device's samples.
struct DeviceReport {
    uint32_t state = uint32_t(SafetyState::kEngaged);
    uint32_t stop_cause = uint32_t(StopCause::kNone);
    uint32_t fault_code = 0;
    uint32_t flags = 0;  // DeviceFlag bits

    bool isEngaged() const noexcept { return state == uint32_t(SafetyState::kEngaged); }
};

}  // namespace bonemill
