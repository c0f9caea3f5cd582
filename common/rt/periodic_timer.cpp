#include "common/rt/periodic_timer.h"

#include <cerrno>

#include "common/base/assert.h"
#include "common/rt/clock.h"

namespace bonemill {

PeriodicTimer::PeriodicTimer(int64_t period_ns, int64_t start_ns) noexcept
    : period_ns_(period_ns), next_ns_(start_ns + period_ns) {
    BONEMILL_ASSERT(period_ns > 0);
}

int64_t PeriodicTimer::advance(int64_t now_ns) noexcept {
    const int64_t late_ns = now_ns - next_ns_;
    if (late_ns >= period_ns_) {
        const int64_t skipped = late_ns / period_ns_;
        missed_ += uint64_t(skipped);
        next_ns_ += skipped * period_ns_;
    }
    const int64_t instant_ns = next_ns_;
    next_ns_ += period_ns_;
    return instant_ns;
}

int64_t PeriodicTimer::waitNext() noexcept {
    const int64_t instant_ns = advance(monotonicNowNs());
    const timespec instant = timespecOfNs(instant_ns);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &instant, nullptr) == EINTR) {
    }
    return instant_ns;
}

}  // namespace bonemill
