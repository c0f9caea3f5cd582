// Command line of device_daemon.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace bonemill {

struct DaemonOptions {
    std::string scene;
    uint32_t session = 0;
    std::optional<double> seconds;       // of the scenario; not given: until the last waypoint
    std::optional<double> wait_seconds;  // how long to wait for haptic_server; not given: for ever
    bool hold = false;
    bool best_effort_realtime = false;
    int core = -1;
    std::string log_level = "info";
};

// Empty after --help (already printed). Throws UserError.
std::optional<DaemonOptions> parseOptions(int argc, char** argv);

}  // namespace bonemill
