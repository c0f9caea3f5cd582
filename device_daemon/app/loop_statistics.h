// Holds what the device loop counted, and writes it as one line of JSON.
#pragma once

#include <cstdint>
#include <string>

#include "common/rt/latency_histogram.h"

namespace bonemill {

struct LoopStatistics {
    uint64_t ticks = 0;
    uint64_t missed_periods = 0;
    double wall_time = 0;             // s
    double scenario_time = 0;         // s
    LatencyHistogram wakeup_latency;  // from the instant that the timer promised to the loop running
    LatencyHistogram compute_time;    // from there to the forces applied
    uint64_t attached_ticks = 0;      // with a haptic_server that answers
    uint64_t late_answers = 0;      // attached ticks whose newest wrench does not answer the previous sample
    double max_tracking_error = 0;  // m, hand against its own wish
    double max_force = 0;           // N, applied to the hand
    double max_torque = 0;          // N·m
    uint64_t clipped_ticks = 0;     // actuator forces reduced to their maximum
    uint64_t rate_limited_ticks = 0;
    uint64_t stop_ticks = 0;  // handle at the end of its workspace
    uint64_t failed_poses = 0;
    std::string final_phase;
};

// Returns one JSON object on one line, with the units in the names.
std::string jsonLineOf(const LoopStatistics& statistics);

}  // namespace bonemill
