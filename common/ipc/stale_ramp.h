// This is the factor on the force when the peer falls silent. It goes from 1 to 0 linearly once the newest
// stamp is too old, and smoothly back to 1 when the peer returns. It is continuous in time, whatever
// interrupts whatever. It starts at 0: force fades in, it never jumps in.
//
// It is RT-safe, for one thread, and pure: time comes in as a parameter (CLOCK_MONOTONIC or simulated).
#pragma once

#include <cstdint>

namespace bonemill {

struct StaleRampConfig {
    int64_t stale_after_ns =
        20'000'000;  // 20 periods of a 1 kHz peer: more than any hiccup of a healthy machine
    int64_t ramp_down_ns = 30'000'000;  // fast enough to be safe, slow enough not to kick
    int64_t ramp_up_ns = 300'000'000;   // slow enough for the hand to notice before it pushes
};

class StaleRamp {
  public:
    explicit StaleRamp(const StaleRampConfig& config = {}) noexcept : config_(config) {}

    // Called once per tick, it returns the factor for this instant. newest_stamp_ns is that of the
    // last plausible message, or any value if none ever came; a stamp farther ahead than stale_after
    // counts as stale.
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
