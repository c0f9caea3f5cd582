// What a living server tells without a pause: its status, the tool while it ticks, nodes while some are
// missing. Each has a reader of its own, and each reader may become deaf by itself. For one thread.
#pragma once

#include <algorithm>
#include <array>

#include "render_client/link/subscribe/deaf_watch.h"

namespace bonemill {

class Hearing {
  public:
    using Clock = DeafWatch::Clock;
    enum Sense { kServer, kTool, kNodes, kSenses };

    explicit Hearing(std::chrono::milliseconds first = DeafWatch::kFirstSilence,
                     Clock::time_point now = Clock::now())
        : watches_{DeafWatch(first, now), DeafWatch(first, now), DeafWatch(first, now)} {}

    // As DeafWatch::pass().
    Clock::duration pass(Clock::time_point now) {
        Clock::duration slept{};
        for (DeafWatch& watch : watches_) slept = watch.pass(now);
        return slept;
    }
    // It was heard, or there is nothing to hear.
    void hear(Sense sense, Clock::time_point now) { watches_[sense].hear(now); }
    // Returns true when the domain is to be joined anew: once for each silence of any of them.
    bool isDue(Clock::time_point now) {
        bool is_due = false;
        for (DeafWatch& watch : watches_) is_due |= watch.isDue(now);
        return is_due;
    }

  private:
    std::array<DeafWatch, kSenses> watches_;
};

}  // namespace bonemill
