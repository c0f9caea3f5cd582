// Opens an input device of the kernel (/dev/input/event*) and asks it what it is like.
//
// It makes system calls and allocates; it is not for the loop.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "device_daemon/hands/input/evdev_state.h"

namespace bonemill {

struct EvdevDevice {
    int file = -1;  // the receiver closes it
    std::string name = {};
    EvdevState state = {};
    bool has_rumble = false;  // it can, and its file may be written
};

// Nothing comes of a path that does not exist, may not be read, or is no input device. An exclusive device is
// heard by no other program from then on: the desktop would take a pedal's key for typing.
std::optional<EvdevDevice> openEvdev(const std::string& path, bool is_exclusive);

// Returns an input device that is there now, or nothing; called on a reading thread.
using EvdevOpener = std::function<std::optional<EvdevDevice>()>;

// Asks for what is held down and where the axes stand. False says that the device does not answer.
bool refreshEvdev(int file, EvdevState& state);

// Hands these bytes of the file to the stream, and asks the device when events were dropped. False says that
// it does not answer.
bool takeEvents(int file, std::span<const std::byte> bytes, EvdevStream& stream);

}  // namespace bonemill
