// Says when a viewer has to tell the others of itself: once per second, 30 times per second while it points,
// and at once when it starts or stops pointing. It is a plain value, for any one thread.
#pragma once

#include <chrono>
#include <optional>

namespace bonemill {

class AnnounceClock {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::nanoseconds kPeriod = std::chrono::seconds(1);
    static constexpr std::chrono::nanoseconds kPointingPeriod = kPeriod / 30;

    // Returns true when it is time now, which then counts as done.
    bool isDue(Clock::time_point now, bool is_pointing) {
        const auto period = is_pointing ? kPointingPeriod : kPeriod;
        if (last_ && is_pointing == was_pointing_ && now - *last_ < period) return false;
        last_ = now;
        was_pointing_ = is_pointing;
        return true;
    }

  private:
    std::optional<Clock::time_point> last_;
    bool was_pointing_ = false;
};

}  // namespace bonemill
