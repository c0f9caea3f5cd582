// Says in plain text what ARES is taken for: for `device_daemon --describe`. It allocates: for start-up.
#pragma once

#include <string>

#include "device_daemon/ares/ares_device/ares_device.h"

namespace bonemill {

// The geometry must be buildable.
std::string describe(const AresDeviceConfig& config);

}  // namespace bonemill
