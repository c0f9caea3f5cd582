// How much a tick may do is fixed at the start, in things counted and not in time, so that a replay
// does the same.
#pragma once

#include <cmath>

#include "haptic_server/core/equilibrium/gradient_config.h"
#include "haptic_server/core/milling/timed_milling.h"

namespace bonemill {

// It is the budget of the gradient law and of milling, by what they cost on a plain PC
// (docs/measurements.md). The thesis' law has only its room for contact points.
struct TickBudget {
    static constexpr double kPointTest = 5e-9, kMilledCell = 4e-9;   // s
    static constexpr double kForceShare = 0.5, kMillingShare = 0.3;  // the rest is for all else

    static void apply(double period, GradientConfig& force, size_t& most_milled_cells) noexcept {
        force.most_point_tests = size_t(std::lround(period * kForceShare / kPointTest));
        most_milled_cells = size_t(std::lround(period * kMillingShare / kMilledCell));
    }
};

}  // namespace bonemill
