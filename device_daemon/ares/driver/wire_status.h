// This translates what a controller says on the wire to what the device loop knows, for joints and poses.
//
// It is RT-safe, and any thread may call it.
#pragma once

#include <cstdint>

#include "common/device_messages/device_messages.h"
#include "device_daemon/ares/wire/packets.h"

namespace bonemill {

// Returns the DeviceStatus bits. `is_trusted`: the link has proved itself; before that nothing is powered.
uint32_t deviceStatusOf(uint32_t inputs, uint16_t statusword, bool is_trusted) noexcept;

// Returns the cause that stops the device, of Fault bits: of several the gravest. kNone without any.
StopCause stopCauseOf(uint32_t faults) noexcept;

// Returns the Button bits of the inputs.
uint32_t buttonsOf(uint32_t inputs) noexcept;

DeviceCapabilities capabilitiesOf(const wire::Describe& description) noexcept;

}  // namespace bonemill
