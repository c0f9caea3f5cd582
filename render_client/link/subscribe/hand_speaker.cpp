#include "render_client/link/subscribe/hand_speaker.h"

#include <utility>

namespace bonemill {

HandSpeaker::HandSpeaker(const Wire& wire, uint32_t session, uint64_t sender, topics::Viewer::Role role,
                         uint32_t first_wish)
    : session_(session), sender_(sender), role_(role), writer_(wire), sequence_(first_wish - 1) {}

uint32_t HandSpeaker::nextWish() {
    constexpr uint32_t kLastWords = 3;
    const std::lock_guard lock(mutex_);
    return sequence_ + kLastWords;
}

HandSpeaker::~HandSpeaker() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        should_stop_ = true;
    }
    changed_.notify_one();
    thread_.join();
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
    write(lock);
}

// The lock is open while DDS writes.
void HandSpeaker::write(std::unique_lock<std::mutex>& lock) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    message_.set_sequence(++sequence_);
    message_.set_stamp_ns(std::chrono::nanoseconds(now).count());
    const std::string bytes = message_.SerializeAsString();
    lock.unlock();
    dds::HandPointerSample sample{};
    sample.session = session_;
    sample.sender = sender_;
    dds::setPayload(sample, bytes);
    writer_.write(sample);
    lock.lock();
}

}  // namespace bonemill
