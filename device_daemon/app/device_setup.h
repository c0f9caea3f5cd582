// Makes the RT-safe parts of the device of the scene file, at start-up: the one place where units
// and frames change.
#pragma once

#include <string>
#include <vector>

#include "device_daemon/driver/ares_emulator.h"
#include "device_daemon/loop/device_loop.h"
#include "proto/scene.pb.h"

namespace bonemill {

struct DeviceSetup {
    uint64_t scene_hash;
    double rate_hz;
    Pose X_WD;
    AresGeometry geometry;
    AresPlant plant;
    HandImpedance hand;
    OperatorPath path;  // waypoints moved from W to D
    std::vector<std::string>
        phases;  // of each waypoint; one without a phase goes on with the phase before it
    DeviceLoopConfig loop;
};

// Throws UserError when the geometry cannot be built or the path leaves the device's workspace.
DeviceSetup deviceSetupOf(const scene::Scene& scene);

}  // namespace bonemill
