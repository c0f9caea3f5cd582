// The pipe between a reader's process and the one that guards it (guarded_import.h).
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {

class Pipe {
  public:
    Pipe() {
        if (pipe2(ends_, O_CLOEXEC) != 0) throw UserError("cannot make a pipe; too many files are open");
        constexpr int kBytes = 1 << 20;  // the two sides change less often than with the usual 64 KiB
        fcntl(ends_[0], F_SETPIPE_SZ, kBytes);
    }
    ~Pipe() {
        closeEnd(0);
        closeEnd(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    int end(int which) const { return ends_[which]; }
    void closeEnd(int which) {
        if (ends_[which] >= 0) close(ends_[which]);
        ends_[which] = -1;
    }

  private:
    int ends_[2];
};

// It is the parent's end of the pipe. It waits for the child until the clock on the wall says that it
// is too late, and calls say_slow() once if that takes longer than people wait without a word.
class Incoming {
  public:
    Incoming(int file, std::chrono::milliseconds most, std::function<void()> say_slow)
        : file_(file),
          end_(Clock::now() + most),
          slow_(Clock::now() + kSlow),
          say_slow_(std::move(say_slow)) {}

    // It is false at the end of the stream, on an error, or when it is too late.
    bool read(void* bytes, size_t count) {
        char* next = static_cast<char*>(bytes);
        while (count > 0) {
            if (!waitForBytes()) return false;
            const ssize_t done = ::read(file_, next, count);
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            next += done;
            count -= size_t(done);
        }
        return true;
    }
    bool isLate() const noexcept { return is_late_; }

  private:
    using Clock = std::chrono::steady_clock;

    bool waitForBytes() {
        pollfd wanted{file_, POLLIN, 0};
        for (;;) {
            saySlowOnce();
            const int64_t left = millisecondsTo(end_);
            const int64_t most =
                say_slow_ ? std::min(millisecondsTo(slow_), kLongestPoll_ms) : kLongestPoll_ms;
            const int ready = poll(&wanted, 1, int(std::clamp<int64_t>(left, 0, most)));
            is_late_ = ready == 0 && left <= most;
            if (ready > 0 || is_late_) return !is_late_;
            if (ready < 0 && errno != EINTR) return false;
        }
    }
    void saySlowOnce() {
        if (say_slow_ && Clock::now() >= slow_) std::exchange(say_slow_, nullptr)();
    }
    static int64_t millisecondsTo(Clock::time_point time) {
        return std::max<int64_t>(0,
                                 std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now()).count());
    }

    static constexpr std::chrono::seconds kSlow{2};
    static constexpr int64_t kLongestPoll_ms = 1'000'000;

    int file_;
    Clock::time_point end_, slow_;
    std::function<void()> say_slow_;
    bool is_late_ = false;
};

// It is false when the other end is gone.
inline bool writeAll(int file, const void* bytes, size_t count) {
    const char* next = static_cast<const char*>(bytes);
    while (count > 0) {
        const ssize_t done = ::write(file, next, count);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        next += done;
        count -= size_t(done);
    }
    return true;
}

}  // namespace bonemill
