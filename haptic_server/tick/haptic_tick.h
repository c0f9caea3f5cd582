// One cycle of the haptic loop: read → pose → contact → solve → limit → write → mill → refresh shell → push
// telemetry. The same tick runs behind the device link in real time and in `simulate` without it.
#pragma once

#include "haptic_server/contact/penalty_contact.h"
#include "haptic_server/coupling/virtual_coupling.h"
#include "haptic_server/milling/timed_milling.h"
#include "haptic_server/tick/bone_model.h"
#include "haptic_server/tick/tick_record.h"
#include "haptic_server/tick/volume_reset.h"

namespace bonemill {

struct DeviceInput {
    Pose X_WT_device;                 // where the hand really holds the tool
    uint32_t buttons = 0;             // Button bits
    double force_factor = 1;          // 1 fresh device; ramps to 0 while it is stale
    bool is_stale = false;            // no fresh sample: nothing is milled
    double t_s = 0;                   // since the session's first tick, or the trajectory file's own time
    int64_t start_ns = 0;             // when this tick began, CLOCK_MONOTONIC
    int64_t deadline_ns = INT64_MAX;  // work that ends later is an overrun
    int64_t wakeup_latency_ns = 0;
};

// What a tick talks to. Implementations are RT-safe: no allocation, lock or system call beyond the wait in
// read().
class TickIo {
  public:
    virtual ~TickIo() = default;
    // Waits for the next tick. False: stop.
    virtual bool read(DeviceInput& input) noexcept = 0;
    // Sends the wrench on the hand (axes W, about the SPO's tool point) and returns the time then, ns.
    virtual int64_t write(const Wrench& wrench_hand_W) noexcept = 0;
    // End of the tick's work: now in ns.
    virtual int64_t now() noexcept = 0;
    // Never blocks: full means dropped and counted.
    virtual void push(const TickRecord& record) noexcept = 0;
};

struct TickConfig {
    double dt = 1e-3;  // s
    PenaltyContactConfig contact;
    CouplingConfig coupling;
    MillingConfig milling;
    double burr_radius = 1e-3;  // m
};

class HapticTick {
  public:
    // Keeps references; allocates the scratch memory of milling. `reset` may be null (no reset then).
    HapticTick(const TickConfig& config, BoneModel& bone, const SdfGrid& tool_sdf, VolumeReset* reset);

    // One tick; RT-safe. False when io.read() said stop. Sets the RtScope guard around its work.
    bool tick(TickIo& io) noexcept;

    // Latched faults of all ticks so far (any bits of TickFault). Tick thread only.
    uint32_t latchedFaults() const noexcept { return latched_faults_; }
    const Pose& spo() const noexcept { return spo_; }

  private:
    Pose acceptPose(const DeviceInput& input, uint32_t& faults) noexcept;
    ContactResult contactInWorld() const noexcept;
    Wrench moveAndFeel(const ContactResult& contact, double force_factor, uint32_t& faults) noexcept;
    MillingResult mill(const DeviceInput& input, uint32_t& faults) noexcept;
    TickRecord makeRecord(const DeviceInput& input, const ContactResult& contact,
                          const Wrench& wrench_hand) const noexcept;

    TickConfig config_;
    BoneModel& bone_;
    const SdfGrid& tool_sdf_;
    VolumeReset* reset_;
    TimedMilling milling_;
    Pose X_VW_;
    Pose device_;
    Pose spo_;
    bool has_pose_ = false;
    uint64_t tick_ = 0;
    uint32_t latched_faults_ = 0;
};

}  // namespace bonemill
