// Reads the command line of ares_emulator.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device_daemon/ares/emulator/fault_spec.h"

namespace bonemill {

struct EmulatorOptions {
    std::string scene;
    std::string address = "127.0.0.1";
    uint16_t port = 0;              // 0: any free one
    uint16_t host_port = 0;         // of this PC, the only one that is listened to; 0: any host
    std::optional<double> rate_hz;  // not given: the scene's
    std::optional<double> seconds;  // of the scenario; not given: until the last waypoint
    bool hold = false;
    double watchdog_ms = 5;
    bool is_unhomed = false;
    std::vector<FaultSpec> faults;
    uint32_t seed = 1;
    bool is_strict_realtime = false;
    int core = -1;  // any
    std::string log_level = "info";
    std::optional<int> parent;  // process to end with
};

// Returns nothing after --help, which is already printed. Throws UserError.
std::optional<EmulatorOptions> parseOptions(int argc, char** argv);

}  // namespace bonemill
