// The newest link in the chain of a journal that is being written (journal_chain.h), for those who keep it
// apart from the journal. It outlives the journal; any normal thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>

namespace bonemill {

class NewestLink {
  public:
    // The recorder thread: this one was written, as hexadecimal digits.
    void set(const std::string& hex) {
        const std::lock_guard lock(mutex_);
        hex_ = hex;
        ++count_;
        has_come_.notify_all();
    }
    // None comes any more.
    void end() {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
        has_come_.notify_all();
    }

    uint64_t count() const {
        const std::lock_guard lock(mutex_);
        return count_;
    }
    // Waits for one that covers what was put into the journal while there were `count` of them: the next may
    // have been closed before it was written, the one after that was not. Returns the newest that there is
    // then, or after `most`; empty if there is none.
    std::string awaitAfter(uint64_t count, std::chrono::milliseconds most) const {
        std::unique_lock lock(mutex_);
        has_come_.wait_for(lock, most, [&] { return is_over_ || count_ >= count + 2; });
        return hex_;
    }

  private:
    mutable std::mutex mutex_;  // guards what is below
    mutable std::condition_variable has_come_;
    std::string hex_;
    uint64_t count_ = 0;
    bool is_over_ = false;
};

}  // namespace bonemill
