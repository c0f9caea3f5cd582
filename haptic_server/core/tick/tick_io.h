// The device as a tick sees it: its input comes from there, its wrench goes there, and it has the clock. All
// else that a tick has to tell is the record that HapticTick::tick() returns.
#pragma once

#include <cstdint>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"
#include "haptic_server/core/telemetry/tick_input.h"

namespace bonemill {

struct DeviceInput {
    Pose X_WT_device;          // where the hand really holds the tool
    bool is_repeated = false;  // no sample came since the last tick: the pose is the one of before
    uint32_t buttons = 0;      // Button bits
    uint32_t placements = 0;   // DeviceSample: a new number puts the simulated tool where the hand is
    DeviceReport device;       // nothing is milled but while it is engaged
    // Another device is there than in the ticks before, and this is what it can do. It is good until the next
    // read(); null says that nothing has changed.
    const DeviceCapabilities* other_device = nullptr;
    uint32_t faults = 0;              // TickFault bits that were found on the way to this tick
    double stale_factor = 1;          // of the force: 1 fresh device; ramps to 0 while it is stale
    bool is_stale = false;            // no fresh sample: nothing is milled
    int periods = 1;                  // that the tick lives through; more when none ran in those before
    double t_s = 0;                   // since the session's first tick, or the trajectory file's own time
    int64_t start_ns = 0;             // when this tick began, CLOCK_MONOTONIC
    int64_t deadline_ns = INT64_MAX;  // work that ends later is an overrun
    int64_t wakeup_latency_ns = 0;
    // In a replay: what was decided for this tick when it ran first, instead of what others say now. It is
    // good until the next read().
    const TickDecisions* decisions = nullptr;

    // Says which share of the period from start to deadline has gone by.
    double shareGone(int64_t now_ns) const noexcept {
        return double(now_ns - start_ns) / double(deadline_ns - start_ns);
    }
};

// A tick talks to this. Implementations are RT-safe: they make no allocation, lock or system call beyond the
// wait in read().
class TickIo {
  public:
    virtual ~TickIo() = default;
    // Waits for the next tick. False says stop.
    virtual bool read(DeviceInput& input) noexcept = 0;
    // Sends the wrench on the hand, in axes W about the tool point that the hand holds, and returns the
    // time then (ns).
    virtual int64_t write(const Wrench& wrench_hand_W) noexcept = 0;
    // Returns the time (ns); the last call is at the end of the tick's work.
    virtual int64_t now() noexcept = 0;
};

// Copies what a tick took in, and what was decided for it, for its record. RT-safe.
inline TickInput recordedInput(const DeviceInput& input, const TickDecisions& decisions) noexcept {
    TickInput out{};
    const Eigen::Quaterniond& q = input.X_WT_device.rotation;
    for (int axis = 0; axis < 3; ++axis) out.p_WT[axis] = input.X_WT_device.position[axis];
    out.q_WT[0] = q.w(), out.q_WT[1] = q.x(), out.q_WT[2] = q.y(), out.q_WT[3] = q.z();
    out.stale_factor = input.stale_factor;
    out.placements = input.placements;
    out.faults = input.faults;
    out.periods = input.periods;
    out.is_repeated = input.is_repeated;
    out.is_stale = input.is_stale;
    out.has_other_device = input.other_device != nullptr;
    if (input.other_device) out.other_device = *input.other_device;
    out.decisions = decisions;
    return out;
}

}  // namespace bonemill
