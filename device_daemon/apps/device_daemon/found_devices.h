// Looks at what could be the hand here: what is plugged in, what the vendors' libraries say, and which is the
// best.
//
// It starts the bridges for a look, which takes seconds when a library hangs. For start-up.
#pragma once

#include <string>
#include <vector>

#include "device_daemon/hands/input/device_list.h"

namespace bonemill {

std::vector<ListedDevice> foundDevices();

// Returns the word for --device of the first usable one: arms come before SpaceMouse, gamepad and mouse.
std::string bestOf(const std::vector<ListedDevice>& devices);

}  // namespace bonemill
