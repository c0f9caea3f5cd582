#include "render_client/web/gateway/send_window.h"

#include <algorithm>
#include <cmath>

namespace bonemill::gateway {
namespace {

constexpr double kAhead_s = 0.3;
constexpr double kMaxCredit_s = 0.25;
constexpr double kRateFading = 0.9;  // per measurement
// The way may have become longer; but what waits on it in a queue of our own making must not count much.
constexpr std::chrono::seconds kTripForgotten{10};
constexpr double kTripGrowth = 1.1;
constexpr double kShortestTrip_s = 1e-4;

double secondsOf(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

SendWindow::SendWindow(double bytes_per_s, Clock::time_point now)
    : bytes_per_s_(bytes_per_s),
      trip_measured_(now),
      credit_(bytes_per_s * kMaxCredit_s),
      credited_(now),
      progress_(now) {}

bool SendWindow::isOpen(Clock::time_point now) {
    credit_ = std::min(credit_ + bytes_per_s_ * secondsOf(now - credited_), bytes_per_s_ * kMaxCredit_s);
    credited_ = now;
    return credit_ > 0 && bytesUnderWay() < window_;
}

size_t SendWindow::frameBytes() const {
    return std::clamp(window_ / 4, kMinFrame, kMaxFrame);
}

void SendWindow::sent(size_t bytes, bool has_more, Clock::time_point now) {
    if (bytesUnderWay() == 0) progress_ = now;
    sent_ += bytes;
    credit_ -= double(bytes);
    frames_.push_back({sent_, acknowledged_, now, has_more});
}

bool SendWindow::acknowledged(uint64_t total_bytes, Clock::time_point now) {
    if (total_bytes < acknowledged_ || total_bytes > sent_) return false;
    if (total_bytes == acknowledged_) return true;
    acknowledged_ = total_bytes;
    progress_ = now;
    std::optional<Frame> newest;
    while (!frames_.empty() && frames_.front().end <= total_bytes) {
        newest = frames_.front();
        frames_.pop_front();
    }
    if (newest) measure(*newest, now);
    return true;
}

void SendWindow::measure(const Frame& frame, Clock::time_point now) {
    const double trip_s = std::max(secondsOf(now - frame.at), kShortestTrip_s);
    if (now - trip_measured_ > kTripForgotten) {
        shortest_trip_s_ *= kTripGrowth;
        trip_measured_ = now;
    }
    if (shortest_trip_s_ == 0 || trip_s < shortest_trip_s_) {
        shortest_trip_s_ = trip_s;
        trip_measured_ = now;
    }
    const double rate = double(acknowledged_ - frame.acknowledged) / trip_s;
    // A link that had little to carry says only that it carries as much.
    link_bytes_per_s_ = frame.is_link_busy ? std::max(rate, kRateFading * link_bytes_per_s_)
                                           : std::max(rate, link_bytes_per_s_);
    if (!frame.is_link_busy && link_bytes_per_s_ <= rate) return;
    const double span_s = std::min(shortest_trip_s_, 1.0) + kAhead_s;
    const double most = std::max(bytes_per_s_ * span_s, double(kMin));
    window_ = size_t(std::clamp(link_bytes_per_s_ * span_s, double(kMin), most));
}

bool SendWindow::isStalled(Clock::time_point now) const {
    return bytesUnderWay() > 0 && now - progress_ > kLongestSilence;
}

}  // namespace bonemill::gateway
