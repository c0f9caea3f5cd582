// Counts pictures per second over the last second. It is a plain value, for any one thread.
#pragma once

#include <chrono>
#include <deque>

namespace bonemill {

class FrameRate {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kWindow{1};

    void countPicture(Clock::time_point now) {
        pictures_.push_back(now);
        // The picture before the window began marks where the first interval starts.
        while (pictures_.size() > 2 && now - pictures_[1] >= kWindow) pictures_.pop_front();
    }
    // It is 0 before the second picture.
    double perSecond() const {
        if (pictures_.size() < 2) return 0;
        const std::chrono::duration<double> span = pictures_.back() - pictures_.front();
        return span.count() > 0 ? double(pictures_.size() - 1) / span.count() : 0;
    }

  private:
    std::deque<Clock::time_point> pictures_;
};

}  // namespace bonemill
