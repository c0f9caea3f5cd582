// Makes the settings of ARES from the scene file, where units change. It is for start-up.
#pragma once

#include "device_daemon/ares/ares_device/ares_device.h"
#include "proto/scene.pb.h"

namespace bonemill {

// An emulated device has no hand that trembles, no home place and no weight: its checks for stuck and frozen
// encoders are milder, and `X_DT_start` is where its handle stands. Throws UserError if the geometry cannot
// be built or the home place is out of reach.
AresDeviceConfig aresConfigOf(const scene::Device& device, bool is_simulated, const Pose& X_DT_start = {});

}  // namespace bonemill
