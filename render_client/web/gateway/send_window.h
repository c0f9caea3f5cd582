// How many bytes a guest is sent ahead of what it has acknowledged: as many as its link carries in its round
// trip and 0.3 s, so that what is newest never waits long behind what is large. Also bounds a guest's share
// of the gateway's uplink. For one thread; times are CLOCK_MONOTONIC.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace bonemill::gateway {

class SendWindow {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr size_t kFirst = 64 << 10, kMin = 16 << 10;  // bytes ahead
    static constexpr std::chrono::seconds kLongestSilence{30};   // with bytes under way
    static constexpr size_t kMinFrame = 8 << 10,
                            kMaxFrame = 64 << 10;  // bytes that a frame is filled up to

    // At most so many bytes per second are sent on average.
    SendWindow(double bytes_per_s, Clock::time_point now);

    // Another frame may be sent now.
    bool isOpen(Clock::time_point now);
    // It is best filled up to so many bytes.
    size_t frameBytes() const;
    // `has_more` says that something else waits already.
    void sent(size_t bytes, bool has_more, Clock::time_point now);
    // Returns false for what cannot be.
    bool acknowledged(uint64_t total_bytes, Clock::time_point now);

    // Bytes are under way, and none of them was acknowledged for too long.
    bool isStalled(Clock::time_point now) const;
    uint64_t sentBytes() const noexcept { return sent_; }
    uint64_t bytesUnderWay() const noexcept { return sent_ - acknowledged_; }
    size_t bytes() const noexcept { return window_; }

  private:
    struct Frame {
        uint64_t end;           // sent bytes with it
        uint64_t acknowledged;  // when it was sent
        Clock::time_point at;
        bool is_link_busy;
    };
    void measure(const Frame& frame, Clock::time_point now);

    const double bytes_per_s_;
    uint64_t sent_ = 0, acknowledged_ = 0;
    size_t window_ = kFirst;
    std::deque<Frame> frames_;  // under way; not longer than the window has bytes
    double link_bytes_per_s_ = 0;
    double shortest_trip_s_ = 0;
    Clock::time_point trip_measured_;
    double credit_;  // bytes
    Clock::time_point credited_;
    Clock::time_point progress_;
};

}  // namespace bonemill::gateway
