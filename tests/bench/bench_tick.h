// Whole ticks over a flat half-filled block.
#pragma once

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "tests/bench/tick_figures.h"

namespace bonemill::bench {

struct TickCase {
    int edge = 512;
    double spacing = 0.096e-3;  // m
    double burr_radius = 3e-3;  // m
    Preset preset = Preset::kBalanced;
    double depth = 1e-3;  // m, commanded, below the face; negative: above it
    bool mills = true;
    int ticks = 4000;
};

TickFigures measureTicks(const TickCase& tick_case);

}  // namespace bonemill::bench
