// Holds what the emulator counted, and writes it as one line of JSON.
#pragma once

#include <cstdint>
#include <string>

#include "device_daemon/ares/wire/packet_flow.h"

namespace bonemill {

struct EmulatorStatistics {
    uint64_t ticks = 0;
    uint64_t missed_periods = 0;
    double wall_time = 0;           // s
    double scenario_time = 0;       // s
    double max_tracking_error = 0;  // m, hand against its own wish
    uint64_t stop_ticks = 0;        // handle at the end of its workspace
    uint64_t packets_sent = 0;
    wire::FlowStatistics commands;
    uint64_t watchdog_trips = 0;
    std::string final_phase;
};

// Returns one JSON object on one line, with the units in the names.
std::string jsonLineOf(const EmulatorStatistics& statistics);

}  // namespace bonemill
