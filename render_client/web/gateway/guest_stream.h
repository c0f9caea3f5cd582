// What one guest is still to be shown of the session, and the frames that show it: of every key only the
// newest payload, however slow the guest is. Holds keys, no payloads but those of density bricks, of which
// few wait.
//
// For one thread; times are CLOCK_MONOTONIC.
#pragma once

#include <deque>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

#include "common/commands/answer.h"
#include "render_client/web/gateway/send_window.h"
#include "render_client/web/gateway/session_state.h"

namespace bonemill::gateway {

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
