// Runs the device loop in its own real-time thread, and looks after it in another.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "common/rt/latency_histogram.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/apps/device_daemon/child_program.h"
#include "device_daemon/apps/device_daemon/daemon_options.h"
#include "device_daemon/apps/device_daemon/resting_hand.h"
#include "device_daemon/apps/device_daemon/scene_follower.h"
#include "device_daemon/control/device_loop/device_loop.h"
#include "device_daemon/control/safety/safety_states.h"

namespace bonemill {

// What the device loop counted.
struct LoopStatistics {
    uint64_t ticks = 0;
    uint64_t missed_periods = 0;      // of the loop's own timer
    double wall_time = 0;             // s
    LatencyHistogram period;          // between two starts of the loop's work
    LatencyHistogram wakeup_latency;  // from the instant that the loop's own timer promised to its work
    LatencyHistogram compute_time;    // from there to the wrench written
    int64_t attached_ns = 0;          // CLOCK_MONOTONIC of the first answer of haptic_server; 0 before
    uint64_t attached_ticks = 0;      // with a haptic_server that answers
    uint64_t late_answers = 0;   // attached ticks whose newest wrench does not answer the previous sample
    uint64_t engaged_ticks = 0;  // the hand felt what was computed
    double max_force = 0;        // N, given to the hand
    double max_torque = 0;       // N·m
    uint64_t clamped_ticks = 0;  // engaged, and the wrench reduced to the device's largest
    uint64_t rate_limited_ticks = 0;
    uint64_t stops = 0;            // limits that have tripped, and faults
    uint64_t unheard_periods = 0;  // no believable reading of the device
    std::string final_state;
};

// What goes on from one scene's daemon to the next one's.
struct DaemonMemory {
    LoopStatistics statistics;
    SafetyLatch stop;                         // a stop holds until a user resets the device
    std::optional<DeviceSample> last_sample;  // that went out; nothing before the first and after a goodbye
    std::optional<RestingHand> between;  // from the end of a hand's loop to the beginning of the next one's
};

// Lets haptic_server tell an orderly end from a fault. RT-safe.
inline void sayGoodbye(DeviceLink& link, DaemonMemory& memory) noexcept {
    if (!memory.last_sample) return;
    memory.last_sample->stamp_ns = monotonicNowNs();
    memory.last_sample->flags |= kDeviceFlagLeaving;
    link.writeSample(*memory.last_sample);
    memory.last_sample.reset();
}

class Daemon {
  public:
    // What the references name, and `program`, which may be null, must outlive the daemon. `scene` is the one
    // that `setup` was made of. What `memory` holds goes on from what it is.
    Daemon(const FollowedScene& scene, const DaemonOptions& options, HapticDevice& device,
           ChildProgram* program, const StopSignals& stop_signals, DeviceLink& link, DaemonMemory& memory);

    enum class End { kLeft, kOtherSceneOrHand };
    // Blocks until the device leaves, --seconds or a signal ends it, or haptic_server has another scene or
    // wants another hand, and the force has ramped to zero. Throws UserError when there is no real-time
    // scheduling with --strict-rt, when no server answered within --wait-seconds, or when the device is not
    // the scene's.
    End run();

  private:
    // The loop writes it and the watcher reads it. Each value is complete in itself, so relaxed
    // order is enough.
    struct Progress {
        std::atomic<bool> is_attached = false;  // haptic_server has answered a sample of this run
        std::atomic<bool> is_server_there = false;
        std::atomic<SafetyState> state = SafetyState::kDisconnected;
        std::atomic<StopCause> cause = StopCause::kNone;
        std::atomic<uint32_t> fault_code = 0;
        std::atomic<uint32_t> abilities = 0;  // DeviceAbility bits
        std::atomic<const char*> refused_figure = nullptr;
        std::atomic<bool> is_finished = false;
    };

    void runLoop();
    void tick(int64_t instant_ns, double elapsed) noexcept;
    bool isAfterAnotherHand() const noexcept;
    void publish(DeviceSample& sample) noexcept;
    void noteAttached(const WrenchCommand& command) noexcept;
    void recordTick(const WrenchCommand* command) noexcept;
    bool shouldEnd() const noexcept;

    void watch();
    void lookForNotice();
    void followHand(const SceneNotice& notice);
    void followAttempts(const SceneNotice& notice);
    void reportServer(bool& was_there) const;
    void reportState(SafetyState& shown_state, StopCause& shown_cause) const;
    void warnOfSilentDevice() const;
    void warnOfMissingSwitch() const;
    void writeBlackBox();

    FollowedScene scene_;
    DaemonOptions options_;
    HapticDevice& device_;
    ChildProgram* program_;
    const StopSignals& stop_signals_;
    DeviceLoop loop_;
    DeviceLink& link_;
    int64_t period_ns_;
    std::atomic<uint32_t> scene_revision_;     // the watcher may find a new one for the same scene
    std::optional<uint32_t> attempt_changes_;  // SceneNotice, as seen last
    std::optional<uint32_t> hand_repeats_;     // likewise
    uint32_t capabilities_version_ = 0;
    int64_t publish_at_ns_ = 0;    // when the next sample is due
    uint64_t first_sequence_ = 0;  // of this run's samples; 0 before the first
    uint64_t last_sequence_ = 0;
    DaemonMemory& memory_;
    LoopStatistics& statistics_;  // memory_'s
    Progress progress_;
    std::atomic<bool> should_stop_ = false;
    std::atomic<bool> is_ending_ = false;
    std::atomic<bool> is_hand_over_ = false;
    std::atomic<bool> is_run_over_ = false;  // another daemon goes on from here
};

}  // namespace bonemill
