#include "haptic_server/scene/trajectory/recorded_row.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace bonemill {
namespace {

enum InputFlag : uint64_t { kRepeated = 1, kStale = 2, kPaused = 4, kRefused = 8 };
constexpr uint64_t kAllFlags = kRepeated | kStale | kPaused | kRefused;
constexpr uint64_t kMaxPeriods = 10'000;
constexpr size_t kDigitsPerByte = 2;

}  // namespace

std::string recordedHeader() {
    std::string header;
    for (const std::string_view name : kRecordedNumbers) header += std::string(name) + ",";
    return header + std::string(kStaleFactorColumn) + "," + std::string(kDeviceColumn);
}

std::array<uint64_t, kRecordedNumbers.size()> numbersOf(const TickInput& input, const DeviceReport& device) {
    const TickDecisions& decisions = input.decisions;
    const uint64_t flags = (input.is_repeated ? uint64_t(kRepeated) : 0) |
                           (input.is_stale ? uint64_t(kStale) : 0) |
                           (decisions.is_milling_paused ? uint64_t(kPaused) : 0) |
                           (decisions.is_write_refused ? uint64_t(kRefused) : 0);
    return {flags,
            uint64_t(std::max(input.periods, 0)),
            input.placements,
            input.faults,
            device.state,
            device.stop_cause,
            device.fault_code,
            device.flags,
            decisions.tool,
            decisions.accuracy,
            decisions.most_samples};
}

bool takeNumbers(const std::array<uint64_t, kRecordedNumbers.size()>& numbers, TickInput& input,
                 DeviceReport& device) {
    const uint64_t flags = numbers[0];
    const bool are_small = std::ranges::all_of(
        numbers, [](uint64_t number) { return number <= std::numeric_limits<uint32_t>::max(); });
    if (!are_small || (flags & ~kAllFlags) || numbers[1] < 1 || numbers[1] > kMaxPeriods) return false;
    input.is_repeated = flags & kRepeated;
    input.is_stale = flags & kStale;
    input.decisions.is_milling_paused = flags & kPaused;
    input.decisions.is_write_refused = flags & kRefused;
    input.periods = int32_t(numbers[1]);
    input.placements = uint32_t(numbers[2]);
    input.faults = uint32_t(numbers[3]);
    device.state = uint32_t(numbers[4]);
    device.stop_cause = uint32_t(numbers[5]);
    device.fault_code = uint32_t(numbers[6]);
    device.flags = uint32_t(numbers[7]);
    input.decisions.tool = uint32_t(numbers[8]);
    input.decisions.accuracy = uint32_t(numbers[9]);
    input.decisions.most_samples = uint32_t(numbers[10]);
    return true;
}

std::string textOfDevice(const DeviceCapabilities& device) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    unsigned char bytes[sizeof device];
    std::memcpy(bytes, &device, sizeof device);
    std::string text;
    for (const unsigned char byte : bytes) {
        text += kDigits[byte / kDigits.size()];
        text += kDigits[byte % kDigits.size()];
    }
    return text;
}

bool takeDevice(std::string_view text, DeviceCapabilities& device) {
    unsigned char bytes[sizeof device];
    if (text.size() != kDigitsPerByte * sizeof bytes) return false;
    for (size_t n = 0; n < sizeof bytes; ++n) {
        const char* const first = text.data() + kDigitsPerByte * n;
        const auto [end, error] = std::from_chars(first, first + kDigitsPerByte, bytes[n], 16);
        if (error != std::errc() || end != first + kDigitsPerByte) return false;
    }
    std::memcpy(&device, bytes, sizeof device);
    return isPlausible(device);
}

}  // namespace bonemill
