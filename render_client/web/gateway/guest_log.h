// What guests and strangers make the gateway say in its log, which they must not fill. For one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "common/log/log.h"

namespace bonemill::gateway {

class GuestLog {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr int kMaxAtOnceOfOne = 10, kMaxAtOnce = 400;
    static constexpr std::chrono::seconds kEachOfOne{30}, kEach{1};  // over a long time
    static constexpr size_t kMaxKnown = 4096;

    enum class Level { kInfo, kWarning };
    // Says it, unless `who` (a guest, an address), or all together, have made it say too much. How many lines
    // were left out stands in the next one.
    void say(Level level, const std::string& who, const std::string& text, Clock::time_point now);

  private:
    void forgetTheQuiet(Clock::time_point now);

    struct One {
        LogLimit limit{kMaxAtOnceOfOne, std::chrono::nanoseconds(kEachOfOne).count()};
        Clock::time_point spoke{};
    };
    std::map<std::string, One> known_;
    Clock::time_point looked_{};
    LogLimit all_{kMaxAtOnce, std::chrono::nanoseconds(kEach).count()};
    int64_t left_out_ = 0;
};

}  // namespace bonemill::gateway
