// Makes the device that --device names.
#pragma once

#include <memory>
#include <string>

#include "device_daemon/apps/device_daemon/child_program.h"
#include "device_daemon/apps/device_daemon/daemon_options.h"
#include "device_daemon/apps/device_daemon/scene_follower.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// What --device takes, for --help.
const char* deviceChoices();

struct ChosenDevice {
    std::unique_ptr<ChildProgram> program;  // emulator or bridge that belongs to it; null without
    std::unique_ptr<HapticDevice> device;
    bool leaves_by_itself = false;  // it keeps to --seconds and the scenario's end
    bool is_of_scene = true;        // another scene needs another one; false: it describes itself
};

// Throws UserError for a word that names no device, and for a device that is not there.
ChosenDevice chooseDevice(const FollowedScene& scene, const DaemonOptions& options);

}  // namespace bonemill
