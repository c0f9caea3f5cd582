// Events that last a tick stay on the screen long enough to be seen. They are plain values, for one thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace bonemill {

class EventLatch {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kShown{500};

    void note(uint32_t events) { pending_ |= events; }

    // Returns the events for a picture drawn at `now`: what was noted since the picture before, and what was
    // shown first less than kShown ago.
    uint32_t show(Clock::time_point now) {
        uint32_t shown = 0;
        for (size_t bit = 0; bit < until_.size(); ++bit) {
            if (pending_ >> bit & 1) until_[bit] = now + kShown;
            if (until_[bit] > now) shown |= 1u << bit;
        }
        pending_ = 0;
        return shown;
    }

  private:
    uint32_t pending_ = 0;
    std::array<Clock::time_point, 32> until_{};
};

}  // namespace bonemill
