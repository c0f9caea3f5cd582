// How much work a tick may do: what is fixed at the start, and what gives way where that is still too much.
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/milling/timed_milling.h"
#include "haptic_server/core/telemetry/tick_input.h"
#include "haptic_server/core/telemetry/tick_record.h"

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

// Finds the preset that there is time for: the one asked for, or the next lower one when the solve of a tick
// was cut short; the lowest keeps all its samples for longest. A truncated solve is another tool in every
// tick; a lower preset is the same one. It goes back up when the finer one could have been afforded for a
// second. Settings that are no preset stay what they are. It is RT-safe, for the tick thread only.
class AffordablePreset {
  public:
    // A tick takes dt seconds.
    explicit AffordablePreset(double dt) noexcept : ticks_of_quiet_(int(kQuiet / dt)) {}

    // After a tick, returns what to compute with; of `step` it takes the overflow that it makes good.
    AccuracySettings settings(const AccuracySettings& asked_for, SpoStep& step) noexcept {
        if (asked_for != asked_for_) lower_by_ = quiet_ = 0;
        asked_for_ = asked_for;
        const size_t asked = placeOf(asked_for), lowest = std::size(kFinestFirst) - 1;
        if (asked > lowest) return asked_for;
        if (step.has_contact_overflow && asked + lower_by_ < lowest) {
            ++lower_by_;
            step.has_contact_overflow = false;
        }
        const bool is_quiet = !step.has_contact_overflow && kTimesAsMuch * step.budget_share < 0.5;
        quiet_ = is_quiet && lower_by_ > 0 ? quiet_ + 1 : 0;
        if (quiet_ > ticks_of_quiet_) --lower_by_, quiet_ = 0;
        return lower_by_ == 0 ? asked_for : presetSettings(kFinestFirst[asked + lower_by_]);
    }
    // The fault that tells of these settings in place of those asked for.
    static uint32_t faultOf(const AccuracySettings& settings) noexcept {
        return settings == presetSettings(Preset::kFast) ? kFaultAsFast : kFaultAsBalanced;
    }

  private:
    static constexpr Preset kFinestFirst[] = {Preset::kExact, Preset::kBalanced, Preset::kFast};
    static constexpr double kQuiet = 1;        // s
    static constexpr double kTimesAsMuch = 4;  // work, in the next finer preset at the most

    static size_t placeOf(const AccuracySettings& settings) noexcept {
        size_t place = 0;
        while (place < std::size(kFinestFirst) && presetSettings(kFinestFirst[place]) != settings) ++place;
        return place;
    }

    int ticks_of_quiet_;
    AccuracySettings asked_for_;
    size_t lower_by_ = 0;
    int quiet_ = 0;
};

// How much of a tick's period its work took.
struct TickLoad {
    double whole, force;
    size_t samples;
    bool is_work_put_off;  // LaterWork says so
};

// Says whether what a tick does when its force is out still fits into the period, by what it took in the last
// ticks. What does not waits for the next tick: heat first, then milling; but no more than kMostWaits ticks.
// Milling that mostly takes more than kMostMilling of the period may work on half as many cells in a tick,
// and half of those, until it has been quick for a second.
//
// Without a deadline, in `simulate`, all fits. It is RT-safe, for the tick thread only.
class LaterWork {
  public:
    enum Stage : uint8_t { kMilling, kHeat };
    static constexpr double kFull = 0.8;  // of the period: more is not begun
    static constexpr int kMostWaits = 3;  // ticks
    static constexpr double kMostMilling = 0.35;

    // A tick takes dt seconds.
    explicit LaterWork(double dt) noexcept : ticks_of_quiet_(int(kQuiet / dt)) {}

    // The tick has used this share of its period.
    bool fits(Stage stage, double used) noexcept {
        Work& work = work_[stage];
        const bool does = used + work.share <= kFull || work.waits == kMostWaits;
        work.waits = does ? 0 : work.waits + 1;
        return does;
    }
    // It was done in this share of the period. It is expected to take as long as it mostly does at most: one
    // tick that was interrupted says little.
    void took(Stage stage, double share) noexcept {
        double& expected = work_[stage].share;
        expected =
            share > expected ? expected + kRise * (std::min(share, 1.0) - expected) : (1 - kFall) * expected;
        if (stage == kMilling) chooseThrift(expected);
    }
    // Milling may work on so many cells divided by 2 to this power.
    int millingThrift() const noexcept { return thrift_; }

  private:
    // A change shows when the leaves have had their turns.
    void chooseThrift(double expected) noexcept {
        const bool has_shown = ++ticks_since_change_ > kTicksToShow;
        quiet_ = 2 * expected < kMostMilling ? quiet_ + 1 : 0;
        const bool is_more = has_shown && expected > kMostMilling &&
                             thrift_<kMostThrift, is_less = quiet_> ticks_of_quiet_ && thrift_ > 0;
        if (!is_more && !is_less) return;
        thrift_ += is_more ? 1 : -1;
        ticks_since_change_ = quiet_ = 0;
    }
    static constexpr int kTicksToShow = 50;
    static constexpr double kQuiet = 1;                  // s
    static constexpr double kRise = 0.25, kFall = 0.01;  // of the way, in a tick
    struct Work {
        double share = 0;
        int waits = 0;
    };
    Work work_[2];
    int ticks_of_quiet_;
    int thrift_ = 0, quiet_ = 0, ticks_since_change_ = kTicksToShow;
};

// Finds how many samples of the bone's surface a tick has time for, on this machine and beside what else runs
// on it. Three ticks within a tenth of a second that fill most of their period, or had to put work off for a
// long force, halve the number; when the ticks have been quick for a second it doubles again, until nothing
// is capped.
//
// Without a deadline, in `simulate`, nothing is late and nothing is capped: the same work gives the same
// bits. It is RT-safe, for the tick thread only.
class SampleCap {
  public:
    // Of the period: a tick is slow beyond the first, and is quick below the second.
    static constexpr double kSlow = 0.7, kQuick = 0.3;
    static constexpr double kLongForce = LaterWork::kFull - LaterWork::kMostMilling;
    static constexpr size_t kFewest = 128;  // which any tick has time for

    // A tick takes dt seconds.
    explicit SampleCap(double dt) noexcept : dt_(dt) {}

    size_t most() const noexcept { return most_; }

    void after(const TickLoad& load) noexcept {
        const bool is_slow = load.whole > kSlow || (load.is_work_put_off && load.force > kLongForce);
        slow_ = is_slow ? slow_ + 1 : std::max(0.0, slow_ - dt_ * kSlowTicks / kSlowWithin);
        quick_for_ = load.whole < kQuick ? quick_for_ + dt_ : 0;
        // One that is slow for another reason has no more samples than it may have, and loses none for it.
        if (slow_ > kSlowTicks - 1) {
            slow_ = 0;
            if (load.samples > kFewest) most_ = std::max(kFewest, std::min(load.samples, most_) / 2);
        } else if (quick_for_ > kQuiet && most_ != SIZE_MAX) {
            quick_for_ = 0;
            most_ = most_ < kMany ? 2 * most_ : SIZE_MAX;
        }
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
