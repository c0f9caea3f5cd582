#include "haptic_server/core/telemetry/fault_names.h"

#include <iterator>

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {
namespace {

// By bit.
constexpr const char* kNames[] = {"overrun",
                                  "stale_device",
                                  "bad_device_pose",
                                  "solve",
                                  "motion_clamped",
                                  "force_clamped",
                                  "shell_overflow",
                                  "contact_overflow",
                                  "volume_full",
                                  "milling_cut_short",
                                  "coarser_shell",
                                  "stalled",
                                  "implausible_device",
                                  "early_samples",
                                  "fewer_samples",
                                  "not_recorded",
                                  "as_balanced",
                                  "as_fast"};
static_assert(1u << (std::size(kNames) - 1) == kLastFault);

}  // namespace

std::vector<std::string> faultList(uint32_t faults) {
    std::vector<std::string> names;
    for (int bit = 0; bit < 32; ++bit) {
        if (!(faults >> bit & 1)) continue;
        names.push_back(bit < std::ssize(kNames) ? kNames[bit] : "unknown_bit_" + std::to_string(bit));
    }
    return names;
}

std::string faultNames(uint32_t faults) {
    std::string text;
    for (const std::string& name : faultList(faults)) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "none" : text;
}

}  // namespace bonemill
