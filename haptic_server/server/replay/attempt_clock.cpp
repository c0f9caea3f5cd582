#include "haptic_server/server/replay/attempt_clock.h"

#include <algorithm>

namespace bonemill {

AttemptClock::AttemptClock(const Recording& shown, const Recording& other, const RecordedAttempt& attempt)
    : shown_(shown),
      other_(other),
      first_(std::min(attempt.begin, other.ticks() - 1)),
      last_(std::clamp(attempt.end, first_, other.ticks() - 1)) {
    for (const RecordedAttempt& leading : recordedAttempts(shown.content()))
        begins_.push_back(std::min(leading.begin, shown.ticks() - 1));
    if (begins_.empty()) begins_.push_back(0);
}

uint64_t AttemptClock::otherTickAt(uint64_t shown_tick) const {
    const auto after = std::ranges::upper_bound(begins_, shown_tick);
    const uint64_t begin = after == begins_.begin() ? begins_.front() : *std::prev(after);
    const double passed_s = shown_.secondsOf(std::max(shown_tick, begin)) - shown_.secondsOf(begin);
    // Ticks begin at whole nanoseconds: the sum of two moments must not end just before its tick.
    constexpr double kHalfNanosecond = 0.5e-9;
    return std::clamp(other_.tickAt(other_.secondsOf(first_) + passed_s + kHalfNanosecond), first_, last_);
}

double AttemptClock::attemptS(uint64_t other_tick) const {
    return other_.secondsOf(std::clamp(other_tick, first_, last_)) - other_.secondsOf(first_);
}

}  // namespace bonemill
