// `haptic_bench tick`: whole ticks over a flat half-filled block.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/rt/latency_histogram.h"
#include "haptic_server/accuracy/accuracy_settings.h"

namespace bonemill::bench {

struct TickCase {
    int edge = 512;
    double spacing = 0.096e-3;  // m
    double burr_radius = 3e-3;  // m
    Preset preset = Preset::kBalanced;
    bool mills = true;
    int ticks = 4000;
};

struct TickFigures {
    LatencyHistogram whole, force, milling;
    double contacts_mean = 0, candidates_mean = 0, iterations_mean = 0;  // per tick in contact
    double removed_voxels_per_tick = 0;
    double force_step_max =
        0;  // N, the largest change of the force from one tick to the next, after the approach
    uint32_t faults = 0;
};

TickFigures measureTicks(const TickCase& tick_case);
nlohmann::json toJson(const TickFigures& figures);

void addTickCommand(CLI::App& app);

}  // namespace bonemill::bench
