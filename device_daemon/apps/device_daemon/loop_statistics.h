// Holds what the device loop counted, and writes it as one line of JSON.
#pragma once

#include <cstdint>
#include <string>

#include "common/rt/latency_histogram.h"

namespace bonemill {

struct LoopStatistics {
    uint64_t ticks = 0;
    uint64_t missed_periods = 0;      // of the loop's own timer
    double wall_time = 0;             // s
    LatencyHistogram period;          // between two starts of the loop's work
    LatencyHistogram wakeup_latency;  // from the instant that the loop's own timer promised to its work
    LatencyHistogram compute_time;    // from there to the wrench written
    int64_t attached_ns = 0;          // CLOCK_MONOTONIC of the first answer of haptic_server; 0 before
    uint64_t attached_ticks = 0;      // with a haptic_server that answers
    uint64_t late_answers = 0;   // attached ticks whose newest wrench does not answer the previous sample
    uint64_t engaged_ticks = 0;  // the hand felt what was computed
    double max_force = 0;        // N, given to the hand
    double max_torque = 0;       // N·m
    uint64_t clamped_ticks = 0;  // engaged, and the wrench reduced to the device's largest
    uint64_t rate_limited_ticks = 0;
    uint64_t stops = 0;            // limits that have tripped, and faults
    uint64_t unheard_periods = 0;  // no believable reading of the device
    std::string final_state;
};

// Returns one JSON object on one line, with the units in the names. `device_words` is a JSON object with
// which the device's own program has ended; it goes along as "device" unless it is empty.
std::string jsonLineOf(const LoopStatistics& statistics, const std::string& device_words);

}  // namespace bonemill
