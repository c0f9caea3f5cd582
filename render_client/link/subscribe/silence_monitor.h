// When to join a DDS domain anew because nothing is heard there: a reader may have become deaf, also one that
// waits for its first server. For one thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace bonemill {

class SilenceMonitor {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kFirstSilence{6000};
    static constexpr std::chrono::seconds kLongestSilence{30};

    // After so much silence, then twice as much and so on up to kLongestSilence.
    explicit SilenceMonitor(std::chrono::milliseconds first = kFirstSilence,
                            Clock::time_point now = Clock::now())
        : first_(first), patience_(first), since_(now) {}

    // Is to be told often that time passes. Returns how long the caller has slept in between, if it has:
    // silence in that time says nothing, and does not count.
    Clock::duration pass(Clock::time_point now) {
        const auto before = std::exchange(passed_, now).value_or(now);
        if (now - before < kSleep) return {};
        since_ += now - before;
        return now - before;
    }
    void hear(Clock::time_point now) {
        since_ = now;
        patience_ = first_;
    }
    // Returns true when the domain is to be joined anew, once for each silence.
    bool isDue(Clock::time_point now) {
        if (now - since_ < patience_) return false;
        patience_ = std::min<std::chrono::milliseconds>(2 * patience_, kLongestSilence);
        since_ = now;
        return true;
    }

  private:
    static constexpr std::chrono::seconds kSleep{1};

    std::chrono::milliseconds first_, patience_;
    Clock::time_point since_;  // it was joined, or something was heard
    std::optional<Clock::time_point> passed_;
};

}  // namespace bonemill
