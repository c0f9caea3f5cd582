// What a viewer says in a session: commands, and where its mouse wants the tool.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/commands/answer.h"
#include "common/geometry/pose.h"
#include "proto/topics.pb.h"
#include "render_client/link/subscribe/wire.h"

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

// Commands are on their way to the server here: one after the other, repeated until acknowledged or timed
// out. It is for one thread.
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

// Tells device_daemon where this viewer's mouse wants the tool (topic HandPointer).
//
// A thread of its own, which begins with the first wish, writes each wish at once and repeats it while
// pictures are slow, so that only a viewer that hangs or is gone falls silent. The functions are for one
// thread; none waits for DDS.
class HandSpeaker {
  public:
    static constexpr std::chrono::milliseconds kRepeat{50};
    static constexpr std::chrono::milliseconds kLongestPicture{1000};  // who has no newer wish hangs
    static constexpr std::chrono::milliseconds kFarewell{
        500};  // letting go is repeated: a message may be lost

    // Says so as this sender and role, in messages that are counted from `first_wish`. What the wire names
    // must outlive the object.
    HandSpeaker(const Wire& wire, uint32_t session, uint64_t sender, topics::Viewer::Role role,
                uint32_t first_wish = 1);
    // Lets go.
    ~HandSpeaker();

    // The tool point is wanted there, with these Button bits, by a viewer that shows this run of the server.
    // A new number of placements asks for it there without a way there.
    void want(const Pose& X_WT, uint32_t buttons, uint32_t placements, uint64_t epoch);
    // The tool is held no more.
    void letGo(uint64_t epoch);
    // Lets go for good, and returns the number of who goes on from here.
    uint32_t stop();

  private:
    using Clock = std::chrono::steady_clock;
    void say(topics::HandPointer message, uint64_t epoch);
    void speak();
    void write(std::unique_lock<std::mutex>& lock);

    const uint32_t session_;
    const uint64_t sender_;
    const topics::Viewer::Role role_;
    Outlet<dds::HandPointerSample> writer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    // The mutex guards these.
    topics::HandPointer message_;
    Clock::time_point said_;
    uint32_t sequence_;
    bool has_news_ = false;
    bool should_stop_ = false;

    std::thread thread_;
};

}  // namespace bonemill
