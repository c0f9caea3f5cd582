// Finds the level of the shell that there is time for: the one asked for, or a coarser one when the points
// near the tool are too many for a tick. It is RT-safe, for the tick thread only.
#pragma once

#include <algorithm>
#include <climits>

#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

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

}  // namespace bonemill
