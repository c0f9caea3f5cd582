// This is a fault that the emulator is told to have, as `--fault` says it.
//
// Reading one allocates and throws UserError; the rest is RT-safe.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

enum class FaultKind {
    // These befall single packets, in both directions.
    kDrop,
    kDelay,
    kDuplicate,
    kReorder,
    kCorrupt,
    kUnplug,
    // These befall the device.
    kStuckEncoder,
    kEncoderOffset,
    kDeadAmplifier,
    kEmergencyStop,
    kOverTemperature,
};

struct FaultSpec {
    FaultKind kind = FaultKind::kDrop;
    int axis = 0;                 // 0 to 5
    double offset = 0;            // m, of kEncoderOffset
    double delay = 0;             // s, of kDelay
    std::optional<double> start;  // s since the hand was engaged first; not given: from the beginning
    double duration = std::numeric_limits<double>::infinity();  // s
    double chance = 1;                                          // of each packet

    // `engaged_s` is the time since the hand was engaged first; negative before.
    bool isActive(double engaged_s) const noexcept {
        return !start || (engaged_s >= *start && engaged_s < *start + duration);
    }
    bool isOfPackets() const noexcept { return kind <= FaultKind::kUnplug; }
};

// Reads "KIND[:ARGUMENT...][@START_S[+DURATION_S]][%PERCENT]".
FaultSpec faultSpecOf(const std::string& text);

// Explains the kinds to users, one line each.
std::string faultHelp();

}  // namespace bonemill
