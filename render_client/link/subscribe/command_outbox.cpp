#include "render_client/link/subscribe/command_outbox.h"

#include <utility>

#include "common/commands/command_rows.h"
#include "common/commands/command_text.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kTimeout = 5s;
constexpr auto kLongTimeout = 300s;  // a large scan on a slow disk
// A first command can be lost while the two sides discover each other; the server carries a
// repeated one out once.
constexpr auto kRepeatAfter = 500ms;

}  // namespace

std::string outcomeText(const CommandOutcome& outcome) {
    return commandText(outcome.command) + ": " + outcome.answer.text;
}

uint32_t CommandOutbox::enqueue(topics::Command command) {
    command.set_sender(sender_);
    command.set_sequence(++last_sequence_);
    waiting_.push_back(std::move(command));
    return last_sequence_;
}

void CommandOutbox::refuseAll(const std::string& why) {
    while (!waiting_.empty()) finish(true, {topics::REFUSED, why});
}

void CommandOutbox::acknowledge(const topics::Status& status) {
    if (waiting_.empty() || status.last_command_sender() != sender_ ||
        status.last_command_sequence() != waiting_.front().sequence())
        return;
    // It is said that a command is done, and never meant by saying nothing.
    finish(true, {status.last_command_outcome(), status.last_command_result().empty()
                                                     ? "the server gave no result"
                                                     : status.last_command_result()});
}

void CommandOutbox::step(Clock::time_point now, bool is_connected,
                         const std::function<void(const topics::Command&)>& write) {
    if (waiting_.empty()) return;
    if (!started_) started_ = now;
    const bool is_long = written_ && rowOf(waiting_.front().action_case()).is_long();
    if (now - *started_ >= (is_long ? kLongTimeout : kTimeout)) {
        finish(false, {topics::UNSAID, written_ ? "the server did not answer" : "no server"});
        return;
    }
    if (!is_connected || (written_ && now - *written_ < kRepeatAfter)) return;
    write(waiting_.front());
    written_ = now;
}

void CommandOutbox::finish(bool is_acknowledged, Answer answer) {
    const uint32_t sequence = waiting_.front().sequence();
    outcomes_.push_back({sequence, std::move(waiting_.front()), is_acknowledged, std::move(answer)});
    waiting_.pop_front();
    started_.reset();
    written_.reset();
}

std::vector<CommandOutcome> CommandOutbox::takeOutcomes() {
    return std::exchange(outcomes_, {});
}

}  // namespace bonemill
