#include "render_client/link/subscribe/viewer_voice.h"

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
// Letting go for good is said so often, as one message may be lost.
constexpr uint32_t kLastWords = 3;
constexpr auto kBetweenLastWords = 5ms;

}  // namespace

HandSpeaker::HandSpeaker(const Wire& wire, uint32_t session, uint64_t sender, topics::Viewer::Role role,
                         uint32_t first_wish)
    : session_(session), sender_(sender), role_(role), writer_(wire), sequence_(first_wish - 1) {}

HandSpeaker::~HandSpeaker() {
    stop();
}

uint32_t HandSpeaker::stop() {
    if (thread_.joinable()) {
        {
            const std::lock_guard lock(mutex_);
            should_stop_ = true;
        }
        changed_.notify_one();
        thread_.join();
    }
    return sequence_ + 1;
}

void HandSpeaker::want(const Pose& X_WT, uint32_t buttons, uint32_t placements, uint64_t epoch) {
    topics::HandPointer message;
    message.mutable_p_wt_m()->Assign(X_WT.position.begin(), X_WT.position.end());
    const Eigen::Quaterniond& q = X_WT.rotation;
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) message.add_q_wt(part);
    message.set_buttons(buttons);
    message.set_placements(placements);
    message.set_is_holding(true);
    say(std::move(message), epoch);
    if (!thread_.joinable()) thread_ = std::thread([this] { speak(); });
}

void HandSpeaker::letGo(uint64_t epoch) {
    say({}, epoch);
}

void HandSpeaker::say(topics::HandPointer message, uint64_t epoch) {
    message.set_epoch(epoch);
    message.set_sender(sender_);
    message.set_role(role_);
    {
        const std::lock_guard lock(mutex_);
        message_ = std::move(message);
        said_ = Clock::now();
        has_news_ = true;
    }
    changed_.notify_one();
}

void HandSpeaker::speak() {
    std::unique_lock lock(mutex_);
    while (!should_stop_) {
        const auto age = Clock::now() - said_;
        has_news_ = false;
        if (age < (message_.is_holding() ? kLongestPicture : kFarewell)) write(lock);
        changed_.wait_for(lock, kRepeat, [this] { return has_news_ || should_stop_; });
    }
    if (!message_.is_holding()) return;
    message_.set_is_holding(false);
    for (uint32_t word = 0; word < kLastWords; ++word) {
        if (word > 0) std::this_thread::sleep_for(kBetweenLastWords);
        write(lock);
    }
}

// The lock is open while DDS writes.
void HandSpeaker::write(std::unique_lock<std::mutex>& lock) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    message_.set_sequence(++sequence_);
    message_.set_stamp_ns(std::chrono::nanoseconds(now).count());
    const std::string bytes = message_.SerializeAsString();
    lock.unlock();
    writer_.write(session_, sender_, bytes);
    lock.lock();
}

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
