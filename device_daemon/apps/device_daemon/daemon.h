// Runs the device loop in its own real-time thread, and looks after it in another.
#pragma once

#include <atomic>
#include <optional>

#include "common/ipc/device_link.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/apps/device_daemon/child_program.h"
#include "device_daemon/apps/device_daemon/daemon_memory.h"
#include "device_daemon/apps/device_daemon/daemon_options.h"
#include "device_daemon/apps/device_daemon/scene_follower.h"
#include "device_daemon/control/device_loop/device_loop.h"

namespace bonemill {

class Daemon {
  public:
    // What the references name, and `program`, which may be null, must outlive the daemon. `scene` is the one
    // that `setup` was made of. What `memory` holds goes on from what it is.
    Daemon(const FollowedScene& scene, const DaemonOptions& options, HapticDevice& device,
           ChildProgram* program, const StopSignals& stop_signals, DeviceLink& link, DaemonMemory& memory);

    enum class End { kLeft, kOtherScene };
    // Blocks until the device leaves, --seconds or a signal ends it, or haptic_server has another scene, and
    // the force has ramped to zero. Throws UserError when there is no real-time scheduling with --strict-rt,
    // when no server answered within --wait-seconds, or when the device is not the scene's.
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
    void publish(DeviceSample& sample) noexcept;
    void noteAttached(const WrenchCommand& command) noexcept;
    void recordTick(const WrenchCommand* command) noexcept;
    bool shouldEnd() const noexcept;

    void watch();
    void lookForNotice();
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
    uint32_t capabilities_version_ = 0;
    int64_t publish_at_ns_ = 0;    // when the next sample is due
    uint64_t first_sequence_ = 0;  // of this run's samples; 0 before the first
    uint64_t last_sequence_ = 0;
    DaemonMemory& memory_;
    LoopStatistics& statistics_;  // memory_'s
    Progress progress_;
    std::atomic<bool> should_stop_ = false;
    std::atomic<bool> is_ending_ = false;
    std::atomic<bool> is_scene_over_ = false;
};

}  // namespace bonemill
