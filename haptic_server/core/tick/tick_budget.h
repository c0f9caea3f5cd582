// How much work a tick may do: what is fixed at the start, and what gives way where that is still too much.
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {

// It is the budget of the gradient law and of milling, by what they cost on a plain PC
// (docs/measurements.md), in things counted and not in time, so that a replay does the same. The thesis' law
// has only its room for contact points.
struct TickBudget {
    static constexpr double kPointTest = 5e-9, kMilledCell = 4e-9;   // s
    static constexpr double kForceShare = 0.5, kMillingShare = 0.3;  // the rest is for all else

    static void apply(double period, GradientConfig& force, size_t& most_milled_cells) noexcept {
        force.most_point_tests = size_t(std::lround(period * kForceShare / kPointTest));
        most_milled_cells = size_t(std::lround(period * kMillingShare / kMilledCell));
    }
};

// Finds the level of the shell that there is time for: the one asked for, or a coarser one when the points
// near the tool are too many for a tick. It is RT-safe, for the tick thread only.
class AffordableShell {
  public:
    // A tick takes dt seconds.
    explicit AffordableShell(double dt) noexcept : ticks_of_quiet_(int(kQuiet / dt)) {}

    // After a tick at the factor `in_force`, returns the one to compute with, or to prepare. From a coarser
    // level than asked for it goes on to the next finer one when that could have been afforded twice over
    // for a second.
    int factor(const PointShell& shell, int asked_for, int in_force, const SpoStep& step) noexcept {
        if (step.has_contact_overflow) finest_ = nextCoarser(shell, in_force);
        if (finest_ <= asked_for) finest_ = 1;
        const double times = double(in_force) / nextFiner(shell, in_force);
        const bool is_quiet =
            !step.has_contact_overflow && in_force == finest_ && step.budget_share * times * times < 0.5;
        quiet_ = is_quiet ? quiet_ + 1 : 0;
        if (quiet_ > ticks_of_quiet_) {
            finest_ = nextFiner(shell, in_force);
            quiet_ = 0;
        }
        return std::max(asked_for, finest_);
    }

  private:
    static constexpr double kQuiet = 1;  // s

    // Both return the same factor if there is none.
    static int nextCoarser(const PointShell& shell, int factor) noexcept {
        int next = INT_MAX;
        for (int level = 0; level < shell.levelCount(); ++level)
            if (const int f = shell.scalingFactor(level); f > factor) next = std::min(next, f);
        return next == INT_MAX ? factor : next;
    }
    static int nextFiner(const PointShell& shell, int factor) noexcept {
        int next = 1;
        for (int level = 0; level < shell.levelCount(); ++level)
            if (const int f = shell.scalingFactor(level); f < factor) next = std::max(next, f);
        return next;
    }

    int ticks_of_quiet_;
    int finest_ = 1;  // factor that can be afforded
    int quiet_ = 0;
};

// Finds how many samples of the bone's surface a tick has time for, on this machine and beside what else runs
// on it. Three ticks within a tenth of a second that fill most of their period halve the number; when the
// ticks have been quick for a second it doubles again, until nothing is capped.
//
// Without a deadline, in `simulate`, nothing is late and nothing is capped: the same work gives the same
// bits. It is RT-safe, for the tick thread only.
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
