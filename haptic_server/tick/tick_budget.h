// How much a tick may do: fixed at the start, in things counted and not in time, so that a replay does the
// same.
#pragma once

#include "haptic_server/milling/timed_milling.h"
#include "haptic_server/spo/gradient_model.h"

namespace bonemill {

// A period's worth of both, at what they cost on a plain PC (docs/measurements.md).
struct TickBudget {
    static constexpr double kPointTest = 5e-9, kMilledCell = 4e-9;  // s
    static constexpr double kForceShare = 0.6;

    static void apply(double period, GradientConfig& force, MillingConfig& milling) noexcept {
        force.most_point_tests = size_t(period * kForceShare / kPointTest);
        milling.most_cells = size_t(period * (1 - kForceShare) / kMilledCell);
    }
};

}  // namespace bonemill
