// What the sticks and buttons of a gamepad mean.
//
//   left stick          moves the tool right, left, up and down in the picture
//   right, left trigger push it into the picture, and pull it out
//   right stick         turns it about the picture's upright and level axes
//   cross left, right   rolls it about the line of sight
//   A (south), B (east) remove, add
//   left shoulder       slow, while held
//
// The names are those of the kernel's gamepad specification, which its drivers follow. Gamepads without a
// driver of their own have the right stick where others have the triggers, and the triggers as buttons.
// It is a pure function.
#pragma once

#include "device_daemon/hands/input/evdev_state.h"
#include "device_daemon/hands/input/hand_input.h"

namespace bonemill {

HandInput handInputOf(const EvdevState& state) noexcept;

}  // namespace bonemill
