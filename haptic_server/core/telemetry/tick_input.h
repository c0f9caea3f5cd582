// This is all that makes a tick what it is: what it took in, before anything of it was accepted or
// normalised, and what the clock or other threads decided for it. Ticks that are given the same again give
// the same bits. It is trivially copyable, a part of TickRecord.
#pragma once

#include <cstdint>
#include <type_traits>

#include "common/device_messages/device_messages.h"

namespace bonemill {

// This is what a tick knew of its device besides where it is and what is pressed. A tick that runs without a
// device, from a file for instance, takes it for engaged. The numbers are those of the device's samples.
struct DeviceReport {
    uint32_t state = uint32_t(SafetyState::kEngaged);
    uint32_t stop_cause = uint32_t(StopCause::kNone);
    uint32_t fault_code = 0;
    uint32_t flags = 0;  // DeviceFlag bits

    bool isEngaged() const noexcept { return state == uint32_t(SafetyState::kEngaged); }
};

inline constexpr int kMostThrift = 3;

// What the tick found decided when it asked.
struct TickDecisions {
    uint32_t tool = 0;      // of ToolSwitch
    uint32_t accuracy = 0;  // of AccuracySwitch
    uint32_t tuning = 0;    // of TuningSwitch
    bool is_milling_paused = false;
    bool is_write_refused = false;                             // by BoneHistory::beginWrite()
    bool is_milling_put_off = false, is_heat_put_off = false;  // by LaterWork
    uint8_t milling_thrift = 0;                                // LaterWork::millingThrift()
    uint32_t most_samples = 0;                                 // SampleCap after the tick; 0: no cap
    uint64_t bone_order = 0;  // BoneHistory::takenUpOrder() after the tick's milling
};

// Those of DeviceInput that are not in the record anyway: t_s, buttons, device and start_ns are.
struct TickInput {
    double p_WT[3];  // X_WT_device
    double q_WT[4];  // w, x, y, z
    double stale_factor;
    uint32_t placements;
    uint32_t faults;
    int32_t periods;
    bool is_repeated, is_stale;
    bool has_other_device;  // then:
    DeviceCapabilities other_device;
    TickDecisions decisions;
};
static_assert(std::is_trivially_copyable_v<TickInput>);

}  // namespace bonemill
