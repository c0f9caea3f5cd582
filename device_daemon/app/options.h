// Reads the command line of device_daemon.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace bonemill {

// Returns the core beside the last one, which haptic_server takes for its tick; -1 (any) on
// a single-core machine.
int defaultCore() noexcept;

struct DaemonOptions {
    std::string scene;
    uint32_t session = 1;
    std::optional<double> seconds;       // of the scenario; not given: until the last waypoint
    std::optional<double> wait_seconds;  // how long to wait for haptic_server; not given: for ever
    bool hold = false;
    bool best_effort_realtime = false;
    int core = defaultCore();
    std::string log_level = "info";
};

// Returns nothing after --help, which is already printed. Throws UserError.
std::optional<DaemonOptions> parseOptions(int argc, char** argv);

}  // namespace bonemill
