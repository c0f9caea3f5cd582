// Makes what the daemon needs of the scene file, at start-up: the place where units and frames change.
#pragma once

#include "common/geometry/hand_space.h"
#include "device_daemon/ares/ares_device/ares_device.h"
#include "device_daemon/control/device_loop/device_loop.h"
#include "device_daemon/hands/input/rate_device.h"
#include "proto/scene.pb.h"

namespace bonemill {

struct DeviceSetup {
    double rate_hz;
    Pose X_WD;
    HandSpace hand_space;
    Pose X_DT_start;        // where the scripted hand begins; D's origin without one
    AresDeviceConfig ares;  // the real one
    AresDeviceConfig simulated_ares;
    RateConfig rates;  // of devices that steer by speed
    DeviceLoopConfig loop;
};

// Throws UserError when the geometry cannot be built.
DeviceSetup deviceSetupOf(const scene::Scene& scene);

}  // namespace bonemill
