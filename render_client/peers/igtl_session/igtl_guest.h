// What one peer has been shown of the session, and what it may do. For one thread; times are CLOCK_MONOTONIC.
#pragma once

#include <array>
#include <chrono>

#include "render_client/peers/igtl_session/bone_pieces.h"

namespace bonemill::igtl {

class IgtlGuest {
  public:
    using Clock = Line::Clock;
    static constexpr std::chrono::milliseconds kPiecePeriod{500};  // the same piece again, at the earliest
    static constexpr size_t kMostBeforePose = 64 << 10;  // waiting bytes: a pose behind more would be old
    static constexpr size_t kMostBeforePiece = 32 << 10;
    static constexpr size_t kMostBeforeText = 1 << 20;

    // The bone is sent at so many bytes per second on average.
    IgtlGuest(Line& line, double bone_bytes_per_s, Clock::time_point now)
        : line_(line), bytes_per_s_(bone_bytes_per_s), credited_(now) {}

    Line& line() noexcept { return line_; }
    // What is new at any time: dropped where too much waits already.
    void sayPose(const Blob& frame) { line_.say(frame, kMostBeforePose); }
    void sayText(const Blob& frame) { line_.say(frame, kMostBeforeText); }
    // Sends one piece of the bone that this peer lacks, if it is due and the budget has room. True: it did.
    bool showPiece(BonePieces& bone, int64_t unix_ns, Clock::time_point now);
    void forgetBone() { shown_.fill(0); }

    bool mayOrder() const noexcept { return may_order_; }
    void allowOrders() noexcept { may_order_ = true; }
    bool wants_image = false;
    int open_orders = 0;

  private:
    Line& line_;
    const double bytes_per_s_;
    double credit_ = 0;  // bytes; below 0 after a piece that was larger
    Clock::time_point credited_;
    std::array<uint32_t, BonePieces::kCount> shown_{};  // revisions
    std::array<Clock::time_point, BonePieces::kCount> shown_at_{};
    bool may_order_ = false;
};

}  // namespace bonemill::igtl
