// Finds how many samples of the bone's surface a tick has time for, on this machine and beside what else runs
// on it. Three ticks within a tenth of a second that fill most of their period halve the number; when the
// ticks have been quick for a second it doubles again, until nothing is capped.
//
// Without a deadline, in `simulate`, nothing is late and nothing is capped: the same work gives the same
// bits. It is RT-safe, for the tick thread only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace bonemill {

class SampleCap {
  public:
    // Of the period: a tick is slow beyond the first, and is quick below the second.
    static constexpr double kSlow = 0.7, kQuick = 0.3;
    static constexpr size_t kFewest = 128;  // which any tick has time for

    // A tick takes dt seconds.
    explicit SampleCap(double dt) noexcept : dt_(dt) {}

    size_t most() const noexcept { return most_; }

    // A tick with so many samples took this share of its period. Returns whether the cap is another one now.
    bool after(double load, size_t samples) noexcept {
        slow_ = load > kSlow ? slow_ + 1 : std::max(0.0, slow_ - dt_ * kSlowTicks / kSlowWithin);
        quick_for_ = load < kQuick ? quick_for_ + dt_ : 0;
        const size_t before = most_;
        // One that is slow for another reason has no more samples than it may have, and loses none for it.
        if (slow_ > kSlowTicks - 1) {
            slow_ = 0;
            if (samples > kFewest) most_ = std::max(kFewest, std::min(samples, most_) / 2);
        } else if (quick_for_ > kQuiet && most_ != SIZE_MAX) {
            quick_for_ = 0;
            most_ = most_ < kMany ? 2 * most_ : SIZE_MAX;
        }
        return most_ != before;
    }

  private:
    static constexpr double kSlowTicks = 3, kSlowWithin = 0.1, kQuiet = 1;  // s
    static constexpr size_t kMany = 8192;                                   // more are never asked for

    double dt_;
    size_t most_ = SIZE_MAX;
    double slow_ = 0;       // ticks, forgotten by and by
    double quick_for_ = 0;  // s
};

}  // namespace bonemill
