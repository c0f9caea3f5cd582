#include "haptic_server/core/telemetry/fault_names.h"

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {
namespace {

const char* nameOf(uint32_t fault) {
    switch (TickFault(fault)) {
        case kFaultNone:
            break;
        case kFaultOverrun:
            return "overrun";
        case kFaultStaleDevice:
            return "stale_device";
        case kFaultBadDevicePose:
            return "bad_device_pose";
        case kFaultSolve:
            return "solve";
        case kFaultMotionClamped:
            return "motion_clamped";
        case kFaultForceClamped:
            return "force_clamped";
        case kFaultShellOverflow:
            return "shell_overflow";
        case kFaultContactOverflow:
            return "contact_overflow";
        case kFaultMillingCutShort:
            return "milling_cut_short";
        case kFaultCoarserShell:
            return "coarser_shell";
        case kFaultVolumeFull:
            return "volume_full";
        case kFaultStalled:
            return "stalled";
        case kFaultImplausibleDevice:
            return "implausible_device";
        case kFaultEarlySamples:
            return "early_samples";
        case kFaultFewerSamples:
            return "fewer_samples";
        case kFaultNotRecorded:
            return "not_recorded";
    }
    return nullptr;
}

}  // namespace

std::vector<std::string> faultList(uint32_t faults) {
    std::vector<std::string> names;
    for (int bit = 0; bit < 32; ++bit) {
        const uint32_t fault = 1u << bit;
        if (!(faults & fault)) continue;
        const char* const name = nameOf(fault);
        names.push_back(name ? name : "unknown_bit_" + std::to_string(bit));
    }
    return names;
}

std::string faultNames(uint32_t faults) {
    std::string text;
    for (const std::string& name : faultList(faults)) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "none" : text;
}

}  // namespace bonemill
