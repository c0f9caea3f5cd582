// Further columns of a trajectory that was recorded: all that a tick took in beside pose and buttons
// (telemetry/tick_input.h). It is for normal threads.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "haptic_server/core/telemetry/tick_input.h"

namespace bonemill {

// Whole numbers; "input_flags" has the bits 1 repeated, 2 stale, 4 milling is paused, 8 the write was
// refused.
inline constexpr std::array<std::string_view, 11> kRecordedNumbers = {
    "input_flags",       "periods",      "placements", "input_faults", "device_state", "stop_cause",
    "device_fault_code", "device_flags", "tool",       "accuracy",     "most_samples"};
inline constexpr std::string_view kStaleFactorColumn = "stale_factor";
// Of another device from this tick on its DeviceCapabilities as hexadecimal digits; else empty.
inline constexpr std::string_view kDeviceColumn = "device";

// The columns' names, with commas.
std::string recordedHeader();

std::array<uint64_t, kRecordedNumbers.size()> numbersOf(const TickInput& input, const DeviceReport& device);
// False for a number that is out of range.
bool takeNumbers(const std::array<uint64_t, kRecordedNumbers.size()>& numbers, TickInput& input,
                 DeviceReport& device);

std::string textOfDevice(const DeviceCapabilities& device);
// False if that is no device.
bool takeDevice(std::string_view text, DeviceCapabilities& device);

}  // namespace bonemill
