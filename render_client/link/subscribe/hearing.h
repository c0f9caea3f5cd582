// What a living server tells without a pause: its status, the tool while it ticks, nodes while some are
// missing. Each has a reader of its own, and each reader may become deaf by itself. For one thread.
#pragma once

#include <algorithm>
#include <array>

#include "render_client/link/subscribe/silence_monitor.h"

namespace bonemill {

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
