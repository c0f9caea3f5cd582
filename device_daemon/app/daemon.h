// Runs the device loop in its own real-time thread, and looks after it in another.
#pragma once

#include <atomic>

#include "common/ipc/device_link.h"
#include "device_daemon/app/device_setup.h"
#include "device_daemon/app/loop_statistics.h"
#include "device_daemon/app/options.h"

namespace bonemill {

class Daemon {
  public:
    // Throws UserError when the session is taken or a permission is missing, among others.
    Daemon(const DeviceSetup& setup, const DaemonOptions& options);

    // Blocks until the scenario, --seconds or a signal ends it and the force has ramped to zero. SIGINT and
    // SIGTERM must be blocked in the calling thread. Throws UserError when there is no real-time scheduling
    // and no --best-effort-rt, or when nobody answered within --wait-seconds.
    void run();

    const LoopStatistics& statistics() const noexcept { return statistics_; }

  private:
    // The loop writes it and the watcher reads it. Each value is complete in itself, so relaxed
    // order is enough.
    struct Progress {
        std::atomic<bool> is_attached = false;  // haptic_server has answered a sample of this run
        std::atomic<bool> is_stale = false;
        std::atomic<int> waypoint = -1;
        std::atomic<double> scenario_time = 0;
        std::atomic<bool> is_finished = false;
    };

    void runLoop();
    void tick(int64_t instant_ns, double elapsed) noexcept;
    void sayGoodbye() noexcept;
    void attachToServer(const WrenchCommand& command, uint64_t sequence) noexcept;
    void recordTick(const WrenchCommand* command, uint64_t sequence) noexcept;
    bool shouldEnd() const noexcept;

    void watch();
    void reportProgress(int& shown_waypoint, bool& shown_stale) const;
    std::string phaseOf(int waypoint) const;

    DeviceSetup setup_;
    DaemonOptions options_;
    double end_time_;  // of the scenario, s
    AresKinematics kinematics_;
    AresEmulator emulator_;
    DeviceLoop loop_;
    DeviceLink link_;
    uint64_t first_sequence_ = 0;  // of this run's samples; 0 before the first
    DeviceSample last_sample_{};
    uint64_t last_sequence_ = 0;
    LoopStatistics statistics_;
    Progress progress_;
    std::atomic<bool> should_stop_ = false;
};

}  // namespace bonemill
