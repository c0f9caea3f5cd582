// Commands are on their way to the server here: one after the other, repeated until acknowledged or timed
// out. It is for one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/commands/answer.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct CommandOutcome {
    uint32_t sequence = 0;
    topics::Command command;
    bool is_acknowledged = false;  // false: no answer in time
    Answer answer;                 // what the server said, or why there is no answer

    // Returns true when the server did what it was asked for.
    bool isDone() const { return is_acknowledged && answer.outcome == topics::DONE; }
};

// Returns "accuracy balanced: done", "accuracy best: refused: ...", "shut down: the server did not answer".
std::string outcomeText(const CommandOutcome& outcome);

class CommandOutbox {
  public:
    using Clock = std::chrono::steady_clock;

    // `sender` must not be 0, and must differ between clients.
    explicit CommandOutbox(uint64_t sender) : sender_(sender) {}

    // Fills in sender and sequence; returns the sequence.
    uint32_t enqueue(topics::Command command);
    // Answers all that wait itself: this viewer may not command.
    void refuseAll(const std::string& why);
    // Takes the server's last acknowledgement; those of other senders are ignored.
    void acknowledge(const topics::Status& status);
    // Gives up on the command under way after its timeout; else passes it to `write` when it is due. A
    // timeout runs from the first step() that finds the command at the head. `is_connected` says
    // whether a server listens.
    void step(Clock::time_point now, bool is_connected,
              const std::function<void(const topics::Command&)>& write);

    std::vector<CommandOutcome> takeOutcomes();
    uint64_t sender() const noexcept { return sender_; }

  private:
    void finish(bool is_acknowledged, Answer answer);

    uint64_t sender_;
    uint32_t last_sequence_ = 0;
    std::deque<topics::Command> waiting_;  // the first one is under way
    std::optional<Clock::time_point> started_;
    std::optional<Clock::time_point> written_;
    std::vector<CommandOutcome> outcomes_;
};

}  // namespace bonemill
