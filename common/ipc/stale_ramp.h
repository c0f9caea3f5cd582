// Factor on the force when the peer falls silent: 1 -> 0 linearly once its newest stamp is too old, and
// smoothly back to 1 when it returns. Continuous in time, whatever interrupts whatever. Starts at 0: force
// fades in, never jumps in.
//
// RT-safe, one thread. Pure: time comes in as a parameter (CLOCK_MONOTONIC or simulated).
#pragma once

#include <cstdint>

namespace bonemill {

struct StaleRampConfig {
    int64_t stale_after_ns =
        20'000'000;  // 20 periods of a 1 kHz peer: more than any hiccup of a healthy machine
    int64_t ramp_down_ns = 50'000'000;  // fast enough to be safe, slow enough not to kick
    int64_t ramp_up_ns = 300'000'000;   // slow enough for the hand to notice before it pushes
};

class StaleRamp {
  public:
    explicit StaleRamp(const StaleRampConfig& config = {}) noexcept : config_(config) {}

    // Once per tick: the factor for this instant. newest_stamp_ns: of the last plausible message; any value
    // if none ever came (a stamp further ahead than stale_after counts as stale).
    double update(int64_t now_ns, int64_t newest_stamp_ns) noexcept;

    double factor() const noexcept { return factor_; }
    bool isStale() const noexcept { return is_stale_; }

  private:
    StaleRampConfig config_;
    bool is_stale_ = true;
    int64_t ramp_start_ns_ = INT64_MIN;
    int64_t updated_ns_ = INT64_MIN;
    double factor_at_start_ = 0.0;
    double factor_ = 0.0;
};

}  // namespace bonemill
