// The text log of a program is spdlog's default logger on stderr. It is never used in the tick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace bonemill {

struct RealtimeReport;

// `level` is trace, debug, info, warn, error or off (as `--log-level`). Throws UserError on any other word.
void setUpLog(const std::string& program, const std::string& level);

// Says what this machine grants a thread that keeps deadlines: its lacks as warnings, advice as information.
void logRealtime(const RealtimeReport& report);

// Lets N messages into the log and counts the rest: anyone who can send a program packets could else
// fill a disk. It is for one thread at a time.
class LogLimit {
  public:
    // This many at once, and over a long time one every `every_ns`.
    LogLimit(int at_once, int64_t every_ns) noexcept : most_(at_once), every_ns_(every_ns), left_(at_once) {}

    // Returns how many messages were left out before this one, or -1: this one is left out as well.
    int64_t ask(int64_t now_ns) noexcept {
        left_ = std::min(most_, left_ + double(now_ns - last_ns_) / double(every_ns_));
        last_ns_ = now_ns;
        if (left_ < 1) {
            ++left_out_;
            return -1;
        }
        left_ -= 1;
        return std::exchange(left_out_, 0);
    }

  private:
    double most_;
    int64_t every_ns_;
    double left_;
    int64_t left_out_ = 0, last_ns_ = 0;
};

}  // namespace bonemill
