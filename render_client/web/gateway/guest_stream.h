// What one guest is still to be shown of the session, and the frames that show it: of every key only the
// newest payload, however slow the guest is. Holds keys, no payloads but those of density bricks, of which
// few wait.
//
// For one thread; times are CLOCK_MONOTONIC.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

#include "common/commands/answer.h"
#include "render_client/web/gateway/session_mirror.h"

namespace bonemill::gateway {

// How many bytes a guest is sent ahead of what it has acknowledged: as many as its link carries in its round
// trip and 0.3 s, so that what is newest never waits long behind what is large. Also bounds a guest's share
// of the gateway's uplink. For one thread; times are CLOCK_MONOTONIC.
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

class GuestStream {
  public:
    using Clock = SendWindow::Clock;
    static constexpr size_t kMaxTogether = 128 << 10;     // bytes of nodes that changed, shown in one frame
    static constexpr std::chrono::seconds kHeartbeat{3};  // something is said so often
    static constexpr size_t kMostBricks = 256;  // that wait; the guest wishes again for what is dropped

    // The state must outlive the stream. The guest holds what the Hello lists.
    GuestStream(const SessionState& state, const Hello& hello, double bytes_per_s, Clock::time_point now);

    // The state has changed so.
    void note(const SessionChanges& changes);
    // The guest wishes for these bricks and no others.
    void wishBricks(std::unordered_set<uint32_t> bricks) { wished_ = std::move(bricks); }
    bool wishesBricks() const noexcept { return !wished_.empty(); }
    // The guest's command ended so, here, before it reached the server.
    void answer(uint64_t sender, uint32_t sequence, Answer answer);

    // There is something to say, and the guest has acknowledged enough.
    bool isDue(Clock::time_point now);
    // Returns the ToGuest frame that is due; empty: none is.
    std::string next(Clock::time_point now);
    // A frame was sent that is not of next().
    void sent(size_t bytes, Clock::time_point now) { window_.sent(bytes, false, now); }
    bool acknowledge(uint64_t bytes, Clock::time_point now) { return window_.acknowledged(bytes, now); }
    bool isStalled(Clock::time_point now) const { return window_.isStalled(now); }
    const SendWindow& window() const noexcept { return window_; }

  private:
    bool hasNews() const;
    void addStatus(Samples& samples);
    void addToolState(Samples& samples);
    bool isNextSmall() const;
    size_t addSmall(Samples& samples, size_t size, size_t most);
    size_t addNodes(Samples& samples, size_t size, size_t most);
    bool areNodesFew(size_t most) const;
    void orderNodes(Clock::time_point now);
    size_t addNode(Samples& samples, uint32_t leaf) const;
    void addBricks(Samples& samples, size_t size, size_t most);

    const SessionState& state_;
    SendWindow window_;
    std::set<std::pair<int, SmallKey>> small_;  // by rank
    std::unordered_set<uint32_t> nodes_;
    std::vector<uint32_t> order_;  // of many nodes: the next one last; some may be sent already
    Clock::time_point ordered_;
    bool has_bone_ = false;  // each node was sent once
    bool has_tool_state_ = false;
    topics::EffectState counted_;  // in tool states that were not sent
    std::deque<SessionChanges::Brick> bricks_;
    std::unordered_set<uint32_t> wished_;
    struct OwnAnswer {
        uint64_t sender;
        uint32_t sequence;
        Answer answer;
    };
    std::deque<OwnAnswer> answers_;
    Clock::time_point said_;
    bool said_server_ = false, said_ended_ = false, has_said_ = false;
};

}  // namespace bonemill::gateway
