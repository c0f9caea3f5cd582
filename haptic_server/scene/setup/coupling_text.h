// Says for people how stiffly a device is held, and what was given up because of what it says of itself.
#pragma once

#include <string>

#include "common/device_messages/device_messages.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

// One line, without an end. It is for start-up and for logs: it fits the coupling anew.
std::string couplingText(const TickConfig& config, const DeviceCapabilities& device);

}  // namespace bonemill
