// Makes the settings of ARES from the scene file, where units change, and says them in plain text. It is for
// start-up.
#pragma once

#include <string>

#include "device_daemon/ares/ares_device/ares_device.h"
#include "proto/scene.pb.h"

namespace bonemill {

// Says what ARES is taken for, for `device_daemon --describe`. The geometry must be buildable.
std::string describe(const AresDeviceConfig& config);

// An emulated device has no hand that trembles, no home place and no weight: its checks for stuck and frozen
// encoders are milder, and `X_DT_start` is where its handle stands. Throws UserError if the geometry cannot
// be built or the home place is out of reach.
AresDeviceConfig aresConfigOf(const scene::Device& device, bool is_simulated, const Pose& X_DT_start = {});

}  // namespace bonemill
