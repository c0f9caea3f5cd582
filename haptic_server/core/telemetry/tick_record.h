// This is what one tick tells the rest of the server. It is trivially copyable and goes through a
// bounded ring.
#pragma once

#include <cstdint>
#include <type_traits>

#include "haptic_server/core/telemetry/cut.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/tick_input.h"

namespace bonemill {

// These bits are the reasons why a tick was not what it should be; they are latched.
enum TickFault : uint32_t {
    kFaultNone = 0,
    kFaultOverrun = 1u << 0,        // the tick's own work took longer than its period
    kFaultStaleDevice = 1u << 1,    // no fresh device sample: force ramps to zero
    kFaultBadDevicePose = 1u << 2,  // non-finite or unnormalisable pose: the last good one is kept
    kFaultSolve = 1u << 3,          // no finite equilibrium: the tool keeps its pose, and the force fades
    kFaultMotionClamped = 1u << 4,  // a speed limit or the trust radius acted
    kFaultForceClamped = 1u << 5,   // the wrench limit acted
    kFaultShellOverflow = 1u << 6,  // the point-shell pool is full: some milled surface has no contact points
    kFaultContactOverflow = 1u << 7,  // more points near the tool than there is room or time for
    kFaultVolumeFull = 1u << 8,       // no memory for more changed bricks: what would need one was not milled
    kFaultMillingCutShort = 1u << 9,  // more to mill than there is time for in a tick: the rest comes later
    kFaultCoarserShell = 1u << 10,    // fewer contact points than asked for: more are too many for a tick
    kFaultStalled = 1u << 11,  // forces are out of balance, but no step towards it was found in this tick
    kFaultImplausibleDevice = 1u << 12,  // what device_daemon says cannot be: it was refused
    kFaultEarlySamples = 1u << 13,       // samples come faster than the loop's rate: the tick was held back
    kFaultFewerSamples = 1u << 14,  // the contact is sampled less finely than asked for: there was no time
    kFaultNotRecorded =
        1u << 15,                 // no tick's: the recording or the trace lacks something (disk full or slow)
    kFaultAsBalanced = 1u << 16,  // a finer preset was asked for: there is no time for it, balanced is felt
    kFaultAsFast = 1u << 17,      // the same; fast is felt
};
constexpr uint32_t kLastFault = kFaultAsFast;

struct TickRecord {
    uint64_t tick;
    int64_t start_ns;           // CLOCK_MONOTONIC at wake-up
    int64_t wakeup_latency_ns;  // from the instant that should have woken the tick to start_ns
    int64_t force_ns;           // start -> wrench written
    int64_t compute_ns;         // start -> end of the tick's work
    double t_s;                 // since the session's first tick; in `simulate` the trajectory's time
    double p_WT[3];             // SPO, m
    double q_WT[4];             // w, x, y, z
    double p_WT_device[3];
    double q_WT_device[4];
    double f_hand_W[3];      // N, on the hand
    double t_hand_W[3];      // N·m, on the hand about the tool point that it holds
    double max_penetration;  // m
    // Of the scene's coupling the gradient law has so much stiffness, 1 for all (tick/hand_coupling.h).
    double coupling_share, rotation_share;
    double removed;  // m³ in this tick
    double added;    // m³ in this tick
    uint32_t contacts;
    uint32_t candidates;      // points near the tool that each iteration tested
    uint32_t iterations;      // of the equilibrium solve
    uint32_t removed_voxels;  // voxels that fell below the iso-value in this tick
    uint32_t added_voxels;    // voxels that rose to the iso-value or above in this tick
    uint32_t buttons;         // Button bits
    uint32_t tool;            // its place in the scene's list of tools, from 0
    bool waits_for_release;   // the bone was put back under a pedal that was down: it is not milled
    uint32_t faults;          // TickFault bits of this tick
    uint64_t bone_order;      // to put the bone back: the newest that is done (BoneHistory::finishedOrder())
    Cut cut;                  // the voxels milled in this tick
    EffectRecord effects;
    DeviceReport device;
    TickInput input;
};
static_assert(std::is_trivially_copyable_v<TickRecord>);

}  // namespace bonemill
