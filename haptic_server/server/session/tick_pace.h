// A tick lives through a fixed time, so that ticks which come faster than their period mill and move too
// fast. This says how early the next one may start. Times are CLOCK_MONOTONIC ns. It is RT-safe, for one
// thread.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bonemill {

// Two ticks are at least half a period apart, so that one that came late is soon caught up with; on average
// they are a period apart, but for the share by which another machine's clock may be faster. After its work a
// tick rests for a quarter as long: a thread with real-time priority that never rests is stopped by the
// kernel for some 50 ms in every second (sched_rt_runtime_us), and the force goes to zero.
class TickPace {
  public:
    explicit TickPace(int64_t period_ns) noexcept : period_ns_(period_ns) {}

    void begin(int64_t start_ns) noexcept {
        last_start_ns_ = start_ns;
        due_ns_ =
            std::max(due_ns_, start_ns - kMaxCaughtUp * period_ns_) + period_ns_ - period_ns_ / kFasterClock;
    }
    // The work of the tick that has begun is done.
    void end(int64_t end_ns) noexcept { rested_ns_ = end_ns + (end_ns - last_start_ns_) / kWorkPerRest; }
    int64_t earliestNs() const noexcept {
        return std::max({last_start_ns_ + period_ns_ / 2, due_ns_, rested_ns_});
    }
    // Tells whether an instant is too early because too many ticks came before it, and not just because the
    // last one was late.
    bool isTooFast(int64_t now_ns) const noexcept { return now_ns < due_ns_; }

  private:
    static constexpr int64_t kMaxCaughtUp = 2;   // periods that silence leaves to be made up for
    static constexpr int64_t kFasterClock = 64;  // 1/64, far more than crystals differ by
    static constexpr int64_t kWorkPerRest = 4;   // the loop takes no more than 80 % of its processor

    int64_t period_ns_;
    int64_t last_start_ns_ = INT64_MIN / 2;
    int64_t due_ns_ = INT64_MIN / 2;
    int64_t rested_ns_ = INT64_MIN / 2;
};

}  // namespace bonemill
