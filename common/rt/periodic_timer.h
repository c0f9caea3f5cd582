// Wakes a loop at fixed instants, by absolute sleep on CLOCK_MONOTONIC, so that nothing drifts. Periods that
// were slept through or overrun are skipped and counted, never made up for in a burst.
//
// It is RT-safe except that it sleeps. One thread uses it.
#pragma once

#include <cstdint>

namespace bonemill {

class PeriodicTimer {
  public:
    // The period must be above 0. The first instant is one period after start_ns (CLOCK_MONOTONIC).
    PeriodicTimer(int64_t period_ns, int64_t start_ns) noexcept;

    // Sleeps until the next instant and returns it; now - result is the wake-up latency.
    int64_t waitNext() noexcept;

    // Does the same arithmetic without the sleep: returns the instant to wait for when the
    // clock shows now_ns.
    int64_t advance(int64_t now_ns) noexcept;

    uint64_t missedPeriods() const noexcept { return missed_; }

  private:
    int64_t period_ns_;
    int64_t next_ns_;
    uint64_t missed_ = 0;
};

}  // namespace bonemill
