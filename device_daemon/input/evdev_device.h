// Opens an input device of the kernel (/dev/input/event*) and asks it what it is like.
//
// It makes system calls and allocates; it is not for the loop.
#pragma once

#include <optional>
#include <string>

#include "device_daemon/input/evdev_state.h"

namespace bonemill {

struct EvdevDevice {
    int file = -1;  // the receiver closes it
    std::string name = {};
    EvdevState state = {};
    bool has_rumble = false;  // it can, and its file may be written
};

// Nothing comes of a path that does not exist, may not be read, or is no input device. An exclusive device is
// heard by nobody else from then on: the desktop would take a pedal's key for typing.
std::optional<EvdevDevice> openEvdev(const std::string& path, bool is_exclusive);

// Asks for what is held down and where the axes stand. False says that the device does not answer.
bool refreshEvdev(int file, EvdevState& state);

}  // namespace bonemill
