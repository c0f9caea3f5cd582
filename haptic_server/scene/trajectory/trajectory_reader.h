// The device poses that `simulate` feeds to the tick: CSV with the header
// t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons (any order, further columns are ignored), one row per tick. Where
// the columns of a recording are all there, too, the rows are what the ticks of a session took in. For normal
// threads.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/core/telemetry/tick_input.h"

namespace bonemill {

// Further columns of a trajectory that was recorded: all that a tick took in beside pose and buttons
// (telemetry/tick_input.h). Whole numbers; "input_flags" has the bits 1 repeated, 2 stale, 4 milling is
// paused, 8 the write was refused, 16 milling and 32 heat were put off; 64 and
// 128 say how thriftily it mills.
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

struct TrajectoryRow {
    double t_s = 0.0;
    Pose X_WT;             // of the device; its quaternion as written, which the tick normalises
    uint32_t buttons = 0;  // Button bits

    struct Recorded {
        TickInput input{};
        DeviceReport device;
    };
    // There in all rows or in none. Then X_WT is as it was recorded, and need be no pose.
    std::shared_ptr<const Recorded> recorded;
};

// There is at least one row, and t_s is strictly increasing. Throws UserError with file:line for a missing
// column, a cell that is no finite number or out of range, a quaternion whose norm is off by more than 1e-3
// and a time that does not increase.
std::vector<TrajectoryRow> readTrajectory(const std::string& path);
// Reads the same from a stream; `name` stands for the file in messages.
std::vector<TrajectoryRow> readTrajectory(std::istream& input, const std::string& name);

}  // namespace bonemill
