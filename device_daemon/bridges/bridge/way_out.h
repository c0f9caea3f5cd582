// Watches over the end of a bridge: it takes the signals that ask for it, and ends the process when a
// vendor's library does not let go in time.
//
// It has a thread of its own, so that it works while a vendor's call never returns. Make it before any other
// thread and before a library is loaded: all threads inherit that the signals are its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "common/base/units.h"
#include "common/rt/stop_signals.h"

namespace bonemill::bridge {

// The process ends with it when time was up: the kernel closes what the library has open, and the arm's own
// watchdog takes the force away.
inline constexpr int kStuckExitCode = 3;
inline constexpr int64_t kTimeToLeaveNs = 2 * kNsPerSecond;

class WayOut {
  public:
    WayOut();
    ~WayOut();

    // SIGINT, SIGTERM or SIGHUP has come; the process has kTimeToLeaveNs left from then on.
    bool isRequested() const noexcept { return is_requested_; }
    // The process is about to end for another reason, and has as much time.
    void begin() noexcept;

  private:
    void watch() noexcept;

    StopSignals stop_signals_;
    std::atomic<bool> is_requested_{false};
    std::atomic<int64_t> deadline_ns_{0};  // 0: none
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

}  // namespace bonemill::bridge
