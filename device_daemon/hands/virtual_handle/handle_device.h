// What every device whose handle is a VirtualHandle says of itself and gives to the loop.
//
// It is RT-safe, for the loop's thread. Wrenches are on the hand, in D.
#pragma once

#include <string_view>

#include "device_daemon/control/haptic_device/haptic_device.h"
#include "device_daemon/hands/virtual_handle/virtual_handle.h"

namespace bonemill {

// The hand is weaker than this, so that it never wins.
inline constexpr double kMaxHandleForce = 10;     // N
inline constexpr double kMaxHandleTorque = 0.15;  // N·m

// A name that is too long is cut.
DeviceCapabilities handleCapabilities(DeviceKind kind, std::string_view name) noexcept;

// What the hand feels of an order. Before it is engaged there is nothing to feel, and afterwards it fades:
// such a handle never feels anything but what is ordered.
Wrench feltWrench(const DeviceOrder& order) noexcept;

// `felt_D` is what the handle has felt since the last reading.
DeviceReading readingOf(const VirtualHandle& handle, const Wrench& felt_D, uint32_t buttons) noexcept;

}  // namespace bonemill
