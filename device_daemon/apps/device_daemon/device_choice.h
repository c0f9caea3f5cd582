// Finds what could be the hand here, and makes the device that --device names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device_daemon/apps/device_daemon/child_program.h"
#include "device_daemon/apps/device_daemon/daemon_options.h"
#include "device_daemon/apps/device_daemon/scene_follower.h"
#include "device_daemon/control/haptic_device/haptic_device.h"
#include "device_daemon/hands/input/device_list.h"

namespace bonemill {

// Looks at what is plugged in, and what the vendors' libraries say. It starts the bridges for a look, which
// takes seconds when a library hangs. For start-up.
std::vector<ListedDevice> foundDevices();

// What --device takes, for --help.
const char* deviceChoices();

struct ChosenDevice {
    std::unique_ptr<ChildProgram> program;  // emulator or bridge that belongs to it; null without
    std::unique_ptr<HapticDevice> device;
    bool leaves_by_itself = false;  // it keeps to --seconds and the scenario's end
    bool is_of_scene = true;        // another scene needs another one; false: it describes itself
};

// The device that --device names, or the mouse where the scene is to have it in place of a scripted hand.
// Throws UserError for a word that names no device, and for a device that is not there.
ChosenDevice chooseDevice(const FollowedScene& scene, const DaemonOptions& options);

}  // namespace bonemill
