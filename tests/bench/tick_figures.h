// Says what `haptic_bench tick` prints of a run of ticks.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill::bench {

// They count the ticks after the approach, unless it says otherwise.
struct TickFigures {
    LatencyHistogram whole, force, milling;
    double contacts_mean = 0;  // of the ticks in contact
    double candidates_mean = 0, iterations_mean = 0;
    double removed_voxels_per_tick = 0;  // of all ticks
    double force_step_max = 0;           // N, the largest change of the force from one tick to the next
    uint32_t faults = 0;                 // of all ticks
};

TickFigures figuresOf(const std::vector<TickRecord>& records, size_t approach_ticks);
nlohmann::json toJson(const TickFigures& figures);

}  // namespace bonemill::bench
