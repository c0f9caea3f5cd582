// Says how many periods a tick lives through: a period in which no tick ran comes with the next one, so that
// what happens at a rate per time (milling, heat, the spindle) is not late on a machine that is. It is
// RT-safe, for one thread. Times are CLOCK_MONOTONIC ns.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bonemill {

class LivedPeriods {
  public:
    explicit LivedPeriods(int64_t period_ns) noexcept
        : period_ns_(period_ns), most_(std::max<int64_t>(1, kMaxNs / period_ns)) {}

    // A tick begins. On average the periods are as many as have passed, but for what a tick may not make up
    // for, which is lost.
    int begin(int64_t start_ns) noexcept {
        const int64_t ahead = kMaxAhead * period_ns_;
        lived_until_ns_ = std::clamp(lived_until_ns_, start_ns - most_ * period_ns_, start_ns + ahead);
        const int64_t late = std::max<int64_t>(0, start_ns - lived_until_ns_) / period_ns_;
        const int64_t periods = is_first_ ? 1 : std::clamp<int64_t>(late, 1, most_);
        lived_until_ns_ = is_first_ ? start_ns : lived_until_ns_ + periods * period_ns_;
        is_first_ = false;
        return int(periods);
    }

    static constexpr int64_t kMaxNs = 20'000'000;  // more is not made up for: a hand cannot follow it

  private:
    static constexpr int64_t kMaxAhead = 2;  // periods that ticks which came too early may have lived

    int64_t period_ns_, most_;
    int64_t lived_until_ns_ = 0;
    bool is_first_ = true;
};

}  // namespace bonemill
