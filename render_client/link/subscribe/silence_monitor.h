// When to join a DDS domain anew because nothing is heard there: a reader may have become deaf, also one that
// waits for its first server. For one thread.
#pragma once

#include <algorithm>
#include <array>
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

// What a living server tells without a pause: its status, the tool while it ticks, nodes while some are
// missing. Each has a reader of its own, and each reader may become deaf by itself. For one thread.
class Hearing {
  public:
    using Clock = SilenceMonitor::Clock;
    enum Sense { kServer, kTool, kNodes, kSenses };

    explicit Hearing(std::chrono::milliseconds first = SilenceMonitor::kFirstSilence,
                     Clock::time_point now = Clock::now())
        : watches_{SilenceMonitor(first, now), SilenceMonitor(first, now), SilenceMonitor(first, now)} {}

    // As SilenceMonitor::pass().
    Clock::duration pass(Clock::time_point now) {
        Clock::duration slept{};
        for (SilenceMonitor& watch : watches_) slept = watch.pass(now);
        return slept;
    }
    // It was heard, or there is nothing to hear.
    void hear(Sense sense, Clock::time_point now) { watches_[sense].hear(now); }
    // Returns true when the domain is to be joined anew: once for each silence of any of them.
    bool isDue(Clock::time_point now) {
        bool is_due = false;
        for (SilenceMonitor& watch : watches_) is_due |= watch.isDue(now);
        return is_due;
    }

  private:
    std::array<SilenceMonitor, kSenses> watches_;
};

}  // namespace bonemill
